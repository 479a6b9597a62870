#include "farm/small_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <span>

#include "core/base/descriptor.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"

namespace hyades::farm {
namespace {

constexpr size_t kMostBytes = size_t{4} << 20U;
constexpr size_t kPiece = size_t{16} << 10U;

core::Error unreadable(const std::string& path, int error) {
  return {path + (error == ENOENT ? ": there is no such file"
                                  : ": cannot be read: " + core::io_reason(error))};
}

}  // namespace

core::Result<std::string> read_small_file(const std::string& path) {
  const core::Descriptor file = core::open_file(path, O_RDONLY);
  if (!file.valid()) return unreadable(path, errno);
  std::string bytes;
  for (size_t size = 0; size <= kMostBytes;) {
    bytes.resize(size + kPiece);
    const auto got =
        core::read_all(file.get(), std::as_writable_bytes(std::span(bytes).subspan(size)));
    if (!got) return unreadable(path, errno);
    size += *got;
    if (*got > 0) continue;
    bytes.resize(size);
    return bytes;
  }
  return core::Error{path + ": has more than 4 MiB: not what is expected here"};
}

core::Status write_secret(const std::string& path, const std::string& text) {
  constexpr mode_t kOwnerOnly = 0600;
  const core::Descriptor file =
      core::open_file(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, kOwnerOnly);
  if (!file.valid()) {
    return core::Error{path + (errno == EEXIST
                                   ? ": is there already: name another, or remove it first"
                                   : ": cannot be made: " + core::io_reason(errno))};
  }
  if (core::write_all(file.get(), std::as_bytes(std::span(text))) && ::fsync(file.get()) == 0) {
    return {};
  }
  const int why = errno;
  (void)::unlink(path.c_str());
  return core::Error{path + ": cannot be written: " + core::io_reason(why)};
}

core::Status replace_secret(const std::string& path, const std::string& text) {
  const std::string fresh = path + ".new";
  (void)::unlink(fresh.c_str());
  if (core::Status written = write_secret(fresh, text); !written) return written;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  if (::rename(fresh.c_str(), path.c_str()) == 0 &&
      core::sync_folder(folder.empty() ? "." : folder)) {
    return {};
  }
  const int why = errno;
  (void)::unlink(fresh.c_str());
  return core::Error{path + ": cannot be written: " + core::io_reason(why)};
}

}  // namespace hyades::farm
