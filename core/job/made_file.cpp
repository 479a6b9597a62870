#include "core/job/made_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <iterator>
#include <memory>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/base/descriptor.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"
#include "core/job/output_path.h"

namespace hyades::core {
namespace {

// O_NONBLOCK: a pipe without a writer must not keep anybody.
constexpr int kToRead = O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
constexpr int kToPass = O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;

Error not_opened(int error) {
  if (error == ENOENT) return Error{"no such file"};
  if (error == ELOOP) return Error{"is a link, a regular file was expected"};
  return Error{"cannot be opened: " + io_reason(error)};
}

/// Opens `path` below `folder` part by part, through no links; the last one with `flags`.
Result<Descriptor> walk(const std::string& folder, const std::string& path, int flags) {
  if (path.find('\0') != std::string::npos || output_name(path) == OutputName::outside) {
    return Error{"does not lie below the folder"};
  }
  Descriptor at = open_file(folder, O_PATH | O_DIRECTORY);
  if (!at.valid()) return not_opened(errno);
  const std::filesystem::path parts(path);
  for (auto part = parts.begin(); part != parts.end(); ++part) {
    const int how = std::next(part) == parts.end() ? flags : kToPass;
    Descriptor below(uninterrupted([&] { return ::openat(at.get(), part->c_str(), how); }));
    if (!below.valid()) return not_opened(errno);
    at = std::move(below);
  }
  return at;
}

/// Opens the file as MadeFile::find() finds it.
Result<Descriptor> open_below(const std::string& folder, const std::string& path,
                              struct stat& info) {
  auto at = walk(folder, path, kToRead);
  if (!at) return at.error();
  if (::fstat(at->get(), &info) != 0) return not_opened(errno);
  if (!S_ISREG(info.st_mode)) return Error{"is no regular file"};
  return at;
}

}  // namespace

Result<MadeFile> MadeFile::find(const std::string& folder, const std::string& path) {
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
         read_all_at(opened->get(), into, offset) == into.size();
}

Result<Bytes> MadeFile::read_whole(uint64_t most) const {
  if (size_ > most) return Error{fmt::format("has {} bytes, more than {}", size_, most)};
  // Not made zero before: it may be large.
  const std::shared_ptr<std::byte[]> bytes(new (std::nothrow) std::byte[size_]);
  if (!bytes) return Error{"not enough memory to read it"};
  const std::span<std::byte> all(bytes.get(), size_);
  if (!read(0, all)) return Error{"cannot be read"};
  return Bytes(bytes, all);
}

void remove_made_folder(const std::string& folder, const std::string& path) {
  const std::filesystem::path whole(path);
  const std::string above = whole.parent_path().string();
  const auto at = above.empty() ? Result<Descriptor>(open_file(folder, O_PATH | O_DIRECTORY))
                                : walk(folder, above, kToPass);
  if (!at || !at->valid()) return;
  std::error_code ignored;
  // remove_all() follows no links itself; by its number the folder above is the one that was found.
  std::filesystem::remove_all(
      fmt::format("/proc/self/fd/{}/{}", at->get(), whole.filename().string()), ignored);
}

}  // namespace hyades::core
