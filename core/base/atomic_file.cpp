#include "core/base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "core/base/descriptor.h"
#include "core/base/failpoint.h"
#include "core/base/hash.h"
#include "core/base/io_reason.h"
#include "core/base/leftovers.h"
#include "core/base/posix_file.h"

namespace hyades::core {
namespace {

Error failure(const std::string& path, int error) {
  return {"cannot write " + path + ": " + io_reason(error)};
}

bool disk_is_full(const std::string& folder) {
  struct statvfs info {};
  return ::statvfs(folder.c_str(), &info) == 0 && info.f_bavail == 0;
}

/// Removes a file at the end of its scope unless `keep`.
struct Temporary {
  std::string path;
  bool keep = false;
  ~Temporary() {
    if (!keep) ::unlink(path.c_str());
  }
};

/// A name beside `target` that nobody else uses: other machines may share the folder, and processes
/// in containers share their numbers, so chance decides.
std::string temporary_name(const std::filesystem::path& target) {
  static const uint64_t process = [] {
    uint64_t value = static_cast<uint64_t>(::getpid());
    // Without the system's chance the process number has to do.
    if (::getrandom(&value, sizeof(value), 0) < 0) errno = 0;
    return value;
  }();
  static std::atomic<uint64_t> counter{0};
  const uint64_t unique = hash_combine(process, counter++);
  // Names may have 255 bytes; the part that makes this one unique needs some of them.
  const std::string base = target.filename().string().substr(0, kNameInTemporary);
  return (target.parent_path() / fmt::format(".{}.{:016x}.tmp", base, unique)).string();
}

}  // namespace

Status replace_file(const std::string& path,
                    const std::function<Status(const std::string&)>& write) {
  if (path.empty() || path.find('\0') != std::string::npos || path.back() == '/') {
    return Error{"cannot write \"" + path + "\": not a file name"};
  }
  std::filesystem::path target = path;
  std::error_code ignored;
  // A link stays a link: what it points to is replaced.
  if (std::filesystem::is_symlink(target, ignored)) {
    const auto resolved = std::filesystem::weakly_canonical(target, ignored);
    if (!ignored) target = resolved;
  }
  struct stat old {};
  const bool exists = ::stat(target.c_str(), &old) == 0;
  if (exists && !S_ISREG(old.st_mode)) {
    return Error{"cannot write " + path + ": it exists and is not a regular file"};
  }
  const std::string folder =
      target.has_parent_path() ? target.parent_path().string() : std::string(".");
  struct stat folder_info {};
  if (::stat(folder.c_str(), &folder_info) != 0) return failure(path, errno);

  Temporary temporary{temporary_name(target)};
  if (const Status written = write(temporary.path); !written) {
    std::string message = written.error().message;
    // Who reads it has never heard of the other name.
    for (size_t at = message.find(temporary.path); at != std::string::npos;
         at = message.find(temporary.path, at)) {
      message.replace(at, temporary.path.size(), path);
    }
    // Encoders often report a failed write without its cause.
    const std::string full = io_reason(ENOSPC);
    const bool add_cause = disk_is_full(folder) && message.find(full) == std::string::npos;
    return Error{add_cause ? message + " (" + full + ")" : message};
  }
  {
    const Descriptor handle = open_file(temporary.path, O_RDWR);
    if (!handle.valid()) return failure(path, errno);
    // Best effort: the new file keeps the old one's permissions.
    if (exists && ::fchmod(handle.get(), old.st_mode & 07777) != 0) errno = 0;
    if (::fsync(handle.get()) != 0) return failure(path, errno);
  }
  failpoint("before-rename");
  if (::rename(temporary.path.c_str(), target.c_str()) != 0) return failure(path, errno);
  temporary.keep = true;
  if (!sync_folder(folder)) return failure(folder, errno);
  return {};
}

Status write_in_place(const std::string& path, std::span<const std::byte> bytes) {
  const Descriptor handle = open_file(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (!handle.valid() || !write_all(handle.get(), bytes)) return failure(path, errno);
  return {};
}

Status write_file(const std::string& path, std::span<const std::byte> bytes) {
  return replace_file(
      path, [&](const std::string& temporary) { return write_in_place(temporary, bytes); });
}

}  // namespace hyades::core
