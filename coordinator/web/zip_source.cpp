#include "coordinator/web/zip_source.h"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <optional>
#include <span>
#include <utility>

#include <archive.h>
#include <archive_entry.h>

namespace hyades::coordinator {
namespace {

/// What the archive's directory and the allocator add for each file, besides its name.
constexpr uint64_t kBytesOfFile = 128;

la_ssize_t append(archive*, void* to, const void* bytes, size_t count) {
  static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), count);
  return static_cast<la_ssize_t>(count);
}

}  // namespace

ZipSource::ZipSource(std::string folder) : folder_(std::move(folder)) {
  archive_ = archive_write_new();
  const bool ready = archive_write_set_format_zip(archive_) == ARCHIVE_OK &&
                     archive_write_zip_set_compression_store(archive_) == ARCHIVE_OK &&
                     archive_write_set_bytes_per_block(archive_, 0) == ARCHIVE_OK &&
                     archive_write_open(archive_, &made_, nullptr, append, nullptr) == ARCHIVE_OK;
  if (!ready) {
    archive_write_free(archive_);
    archive_ = nullptr;
  }
}

ZipSource::~ZipSource() {
  if (archive_ != nullptr) archive_write_free(archive_);
}

void ZipSource::add(std::string name, uint64_t size) {
  bytes_kept_ += 2 * name.size() + sizeof(File) + kBytesOfFile;
  files_.push_back({std::move(name), size});
}

std::optional<std::string> ZipSource::next() {
  if (archive_ == nullptr) return std::nullopt;
  while (!over_ && made_.size() < kPieceBytes) {
    if (!step()) return std::nullopt;
  }
  return std::exchange(made_, {});
}

/// The next file's header, some more of its bytes, or the archive's end.
bool ZipSource::step() {
  if (in_file_) {
    std::string piece(std::min<uint64_t>(kPieceBytes, bytes_.size() - at_), '\0');
    if (!bytes_.read(at_, std::as_writable_bytes(std::span(piece))) ||
        archive_write_data(archive_, piece.data(), piece.size()) !=
            static_cast<la_ssize_t>(piece.size())) {
      return false;
    }
    at_ += piece.size();
    in_file_ = at_ < bytes_.size();
    return true;
  }
  if (file_ == files_.size()) {
    over_ = true;
    return archive_write_close(archive_) == ARCHIVE_OK;
  }
  const File& file = files_[file_++];
  auto bytes = core::MadeFile::find(folder_, file.name);
  if (!bytes || bytes->size() != file.size) return false;
  bytes_ = std::move(*bytes);
  archive_entry* entry = archive_entry_new();
  archive_entry_set_pathname(entry, file.name.c_str());
  archive_entry_set_size(entry, static_cast<la_int64_t>(file.size));
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_entry_set_perm(entry, 0644);
  archive_entry_set_mtime(entry, std::time(nullptr), 0);
  const bool written = archive_write_header(archive_, entry) == ARCHIVE_OK;
  archive_entry_free(entry);
  at_ = 0;
  in_file_ = bytes_.size() > 0;
  return written;
}

}  // namespace hyades::coordinator
