#include "coordinator/finisher/made_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <iterator>
#include <memory>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "core/base/descriptor.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"
#include "core/job/output_path.h"

namespace hyades::coordinator {
namespace {

// O_NONBLOCK: a pipe without a writer must not keep anybody.
constexpr int kToRead = O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
constexpr int kToPass = O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;

core::Error not_opened(int error) {
  if (error == ENOENT) return core::Error{"no such file"};
  if (error == ELOOP) return core::Error{"is a link, a regular file was expected"};
  return core::Error{"cannot be opened: " + core::io_reason(error)};
}

/// Opens the file as MadeFile::find() finds it.
core::Result<core::Descriptor> open_below(const std::string& folder, const std::string& path,
                                          struct stat& info) {
  if (path.find('\0') != std::string::npos ||
      core::output_name(path) == core::OutputName::outside) {
    return core::Error{"does not lie below the folder"};
  }
  core::Descriptor at = core::open_file(folder, O_PATH | O_DIRECTORY);
  if (!at.valid()) return not_opened(errno);
  const std::filesystem::path parts(path);
  for (auto part = parts.begin(); part != parts.end(); ++part) {
    const int flags = std::next(part) == parts.end() ? kToRead : kToPass;
    core::Descriptor below(
        core::uninterrupted([&] { return ::openat(at.get(), part->c_str(), flags); }));
    if (!below.valid()) return not_opened(errno);
    at = std::move(below);
  }
  if (::fstat(at.get(), &info) != 0) return not_opened(errno);
  if (!S_ISREG(info.st_mode)) return core::Error{"is no regular file"};
  return at;
}

}  // namespace

core::Result<MadeFile> MadeFile::find(const std::string& folder, const std::string& path) {
  struct stat info {};
  const auto opened = open_below(folder, path, info);
  if (!opened) return opened.error();
  MadeFile file;
  file.folder_ = folder;
  file.path_ = path;
  file.size_ = static_cast<uint64_t>(info.st_size);
  file.device_ = info.st_dev;
  file.number_ = info.st_ino;
  return file;
}

bool MadeFile::read(uint64_t offset, std::span<std::byte> into) const {
  struct stat info {};
  const auto opened = open_below(folder_, path_, info);
  return opened && info.st_dev == device_ && info.st_ino == number_ &&
         core::read_all_at(opened->get(), into, offset) == into.size();
}

core::Result<core::Bytes> MadeFile::read_whole(uint64_t most) const {
  if (size_ > most) return core::Error{fmt::format("has {} bytes, more than {}", size_, most)};
  // Not made zero before: it may be large.
  const std::shared_ptr<std::byte[]> bytes(new (std::nothrow) std::byte[size_]);
  if (!bytes) return core::Error{"not enough memory to read it"};
  const std::span<std::byte> all(bytes.get(), size_);
  if (!read(0, all)) return core::Error{"cannot be read"};
  return core::Bytes(bytes, all);
}

}  // namespace hyades::coordinator
