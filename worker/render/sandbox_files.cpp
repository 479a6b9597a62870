#include "worker/render/sandbox_files.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "core/base/descriptor.h"

namespace hyades::worker {
namespace {

using core::Error;
using core::Status;

// C libraries have no functions for these calls yet.
int create_ruleset(const landlock_ruleset_attr* attributes, size_t size, uint32_t flags) {
  return static_cast<int>(::syscall(SYS_landlock_create_ruleset, attributes, size, flags));
}
int add_path(int ruleset, const landlock_path_beneath_attr& rule) {
  return static_cast<int>(
      ::syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0));
}
int restrict_self(int ruleset) {
  return static_cast<int>(::syscall(SYS_landlock_restrict_self, ruleset, 0));
}

constexpr uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
/// All that ABI 1 knows: everything but what is allowed below is refused.
constexpr uint64_t kAbi1 = (uint64_t{LANDLOCK_ACCESS_FS_MAKE_SYM} << 1U) - 1;
/// Moving files to other folders (ABI 2) and shortening them (ABI 3).
constexpr uint64_t kRefer = uint64_t{1} << 13U;
constexpr uint64_t kTruncate = uint64_t{1} << 14U;

/// What there is of these may be read. Not /etc, not /home and not what /proc tells of
/// others: there are keys and tokens.
constexpr std::array kSystem = {"/usr",
                                "/lib",
                                "/lib64",
                                "/etc/ld.so.cache",
                                "/proc/self",
                                "/proc/cpuinfo",
                                "/proc/meminfo",
                                "/proc/stat",
                                "/proc/sys/vm/overcommit_memory",
                                "/sys/devices/system",
                                "/sys/fs/cgroup",
                                "/dev/null",
                                "/dev/urandom"};

Error failure(const std::string& what) {
  return Error{"Landlock: " + what + ": " + std::strerror(errno)};
}

Status allow(int ruleset, const std::string& path, uint64_t access, bool must_exist) {
  const core::Descriptor place(::open(path.c_str(), O_PATH | O_CLOEXEC));
  struct stat info {};
  if (place.get() < 0 || ::fstat(place.get(), &info) != 0) {
    if (!must_exist) return {};
    return failure(path);
  }
  if (!S_ISDIR(info.st_mode)) access &= ~uint64_t{LANDLOCK_ACCESS_FS_READ_DIR};
  landlock_path_beneath_attr rule{};
  rule.allowed_access = access;
  rule.parent_fd = place.get();
  if (add_path(ruleset, rule) != 0) return failure(path);
  return {};
}

}  // namespace

Status restrict_files(const std::string& cache) {
  const int abi = create_ruleset(nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (abi < 1) return failure("not in this kernel, switched off or refused");
  landlock_ruleset_attr attributes{};
  attributes.handled_access_fs = kAbi1;
  if (abi >= 2) attributes.handled_access_fs |= kRefer;
  if (abi >= 3) attributes.handled_access_fs |= kTruncate;
  const core::Descriptor ruleset(create_ruleset(&attributes, sizeof attributes, 0));
  if (ruleset.get() < 0) return failure("no rules");
  for (const char* path : kSystem) {
    if (Status status = allow(ruleset.get(), path, kRead, false); !status) return status;
  }
  // Not to remove either: there are other jobs' files, and the worker's id.
  const Status status = allow(ruleset.get(), cache, kRead, true);
  if (!status) return status;
  if (restrict_self(ruleset.get()) != 0) return failure("refused");
  return {};
}

}  // namespace hyades::worker
