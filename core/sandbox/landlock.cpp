#include "core/sandbox/landlock.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

#include "core/base/descriptor.h"

namespace hyades::core {
namespace {

// C libraries have no functions for these calls yet.
int create_ruleset(const void* attributes, size_t size, uint32_t flags) {
  return static_cast<int>(::syscall(SYS_landlock_create_ruleset, attributes, size, flags));
}
int add_path(int ruleset, const landlock_path_beneath_attr& rule) {
  return static_cast<int>(
      ::syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0));
}
int restrict_self(int ruleset) {
  return static_cast<int>(::syscall(SYS_landlock_restrict_self, ruleset, 0));
}
int abi_version() { return create_ruleset(nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION); }

/// All that ABI 1 knows: everything but what a rule allows is refused.
constexpr uint64_t kAbi1 = (uint64_t{LANDLOCK_ACCESS_FS_MAKE_SYM} << 1U) - 1;
/// Moving files to other folders (ABI 2) and shortening them (ABI 3), which older headers lack.
constexpr uint64_t kRefer = uint64_t{1} << 13U;
constexpr uint64_t kTruncate = uint64_t{1} << 14U;
/// `scoped`: no signals to processes that are not below the same rules (ABI 6).
constexpr uint64_t kSignals = uint64_t{1} << 1U;

/// landlock_ruleset_attr as of ABI 6; kernels take what is zero beyond what they know.
struct RulesetAttributes {
  uint64_t handled_access_fs = 0;
  uint64_t handled_access_net = 0;
  uint64_t scoped = 0;
};

constexpr uint64_t kOfFolders = LANDLOCK_ACCESS_FS_READ_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
                                LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                                LANDLOCK_ACCESS_FS_MAKE_DIR | kRefer;

uint64_t rights_of(FileAccess access) {
  constexpr uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
  switch (access) {
    case FileAccess::read:
      return kRead;
    case FileAccess::run:
      return kRead | LANDLOCK_ACCESS_FS_EXECUTE;
    case FileAccess::write:
      return kRead | LANDLOCK_ACCESS_FS_WRITE_FILE | kTruncate | kOfFolders;
  }
  return 0;
}

Error failure(const std::string& what) {
  return Error{"Landlock: " + what + ": " + std::strerror(errno)};
}

Status add(int ruleset, const FileRule& rule, uint64_t handled) {
  const Descriptor place(::open(rule.path.c_str(), O_PATH | O_CLOEXEC));
  struct stat info {};
  if (place.get() < 0 || ::fstat(place.get(), &info) != 0) {
    if (!rule.must_exist) return {};
    return failure(rule.path);
  }
  landlock_path_beneath_attr beneath{};
  beneath.allowed_access = rights_of(rule.access) & handled;
  if (!S_ISDIR(info.st_mode)) beneath.allowed_access &= ~kOfFolders;
  beneath.parent_fd = place.get();
  if (add_path(ruleset, beneath) != 0) return failure(rule.path);
  return {};
}

}  // namespace

std::vector<FileRule> system_files() {
  std::vector<FileRule> rules;
  for (const char* path :
       {"/usr", "/lib", "/lib64", "/etc/ld.so.cache", "/etc/alternatives", "/proc/self",
        "/proc/cpuinfo", "/proc/meminfo", "/proc/stat", "/proc/sys/vm/overcommit_memory",
        "/sys/devices/system", "/sys/fs/cgroup", "/dev/null", "/dev/urandom"}) {
    rules.push_back({path});
  }
  return rules;
}

Status restrict_files(const std::vector<FileRule>& rules) {
  // Without privileges a process may restrict itself only where it can gain none.
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return failure("no_new_privs");
  if (const std::string lacks = landlock_lacks(); !lacks.empty()) return Error{lacks};
  const int abi = abi_version();
  RulesetAttributes attributes;
  attributes.handled_access_fs = kAbi1;
  if (abi >= 2) attributes.handled_access_fs |= kRefer;
  if (abi >= 3) attributes.handled_access_fs |= kTruncate;
  if (abi >= 6) attributes.scoped = kSignals;
  const Descriptor ruleset(create_ruleset(&attributes, sizeof attributes, 0));
  if (ruleset.get() < 0) return failure("no rules");
  for (const FileRule& rule : rules) {
    if (Status added = add(ruleset.get(), rule, attributes.handled_access_fs); !added) return added;
  }
  if (restrict_self(ruleset.get()) != 0) return failure("refused");
  return {};
}

std::string landlock_lacks() {
  return abi_version() >= 1 ? std::string()
                            : failure("not in this kernel, switched off or refused").message;
}

}  // namespace hyades::core
