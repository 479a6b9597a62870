#include "worker/render/sandbox_calls.h"

#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>

namespace hyades::worker {
namespace {

using core::Error;
using core::Status;

/// What rendering never does. Names that this machine's kernel does not have are left out.
constexpr std::array kForbidden = {
    // the network, and other processes through sockets
    "socket", "socketpair", "connect", "bind", "listen", "accept", "accept4",
    // other programs and processes
    "execve", "execveat", "fork", "vfork", "kill", "tkill", "rt_sigqueueinfo", "rt_tgsigqueueinfo",
    "pidfd_open", "pidfd_getfd", "pidfd_send_signal", "process_mrelease", "ptrace",
    "process_vm_readv", "process_vm_writev", "process_madvise", "kcmp", "setns", "unshare",
    "shmget", "shmat", "shmctl", "msgget", "msgsnd", "msgrcv", "msgctl", "semget", "semop",
    "semtimedop", "semctl", "mq_open", "mq_unlink", "setpriority", "ioprio_set", "migrate_pages",
    "move_pages",
    // memory that RLIMIT_DATA does not count
    "memfd_create", "memfd_secret",
    // the file system, where Landlock does not reach
    "mount", "umount2", "pivot_root", "chroot", "fsopen", "fsmount", "move_mount", "open_tree",
    "open_by_handle_at", "name_to_handle_at", "quotactl", "swapon", "swapoff", "chmod", "fchmod",
    "fchmodat", "chown", "fchown", "lchown", "fchownat", "setxattr", "lsetxattr", "fsetxattr",
    "mknod", "mknodat", "fanotify_init", "truncate", "creat", "fsconfig", "fspick", "mount_setattr",
    "quotactl_fd",
    // the kernel itself
    "bpf", "perf_event_open", "userfaultfd", "io_uring_setup", "io_uring_enter",
    "io_uring_register", "keyctl", "add_key", "request_key", "init_module", "finit_module",
    "delete_module", "kexec_load", "kexec_file_load", "reboot", "acct", "syslog", "settimeofday",
    "clock_settime", "clock_adjtime", "adjtimex", "sethostname", "setdomainname", "iopl", "ioperm",
    "personality", "modify_ldt", "vhangup", "nfsservctl", "lookup_dcookie", "uselib", "ustat",
    "sysfs", "setuid", "setgid", "setreuid", "setregid", "setresuid", "setresgid", "setgroups",
    "setfsuid", "setfsgid", "capset"};

/// Calls that the library of this machine may have no name for yet: fchmodat2.
constexpr std::array kForbiddenNumbers = {452};

/// A system call that fails with `error` where its argument number `argument`, under `mask`,
/// compares so.
struct Rule {
  int call;
  int error;
  unsigned argument;
  scmp_compare compare;
  uint64_t value, mask = 0;
};

/// What is forbidden in some cases only.
std::array<Rule, 13> rules() {
  const auto own = static_cast<uint64_t>(::getpid());
  constexpr uint64_t kLow = 0xFFFFFFFF;  // of a register of 64 bits
  constexpr uint64_t kSharedNameless = MAP_SHARED | MAP_ANONYMOUS;
  return {{
      // Threads are made by clone, processes too.
      {SCMP_SYS(clone), EPERM, 0, SCMP_CMP_MASKED_EQ, CLONE_THREAD, 0},
      // abort() and raise() signal one's own threads; limits are asked and set for oneself.
      {SCMP_SYS(tgkill), EPERM, 0, SCMP_CMP_NE, own},
      {SCMP_SYS(prlimit64), EPERM, 0, SCMP_CMP_NE, 0},
      // The calling thread's own, for libraries that tie threads to processors.
      {SCMP_SYS(sched_setaffinity), EPERM, 0, SCMP_CMP_NE, 0},
      {SCMP_SYS(sched_setscheduler), EPERM, 0, SCMP_CMP_NE, 0},
      {SCMP_SYS(sched_setparam), EPERM, 0, SCMP_CMP_NE, 0},
      {SCMP_SYS(sched_setattr), EPERM, 0, SCMP_CMP_NE, 0},
      // Memory that RLIMIT_DATA does not count, as it belongs to no process alone, or to a stack.
      {SCMP_SYS(mmap), EPERM, 3, SCMP_CMP_MASKED_EQ, kSharedNameless, kSharedNameless},
      {SCMP_SYS(mmap), EPERM, 3, SCMP_CMP_MASKED_EQ, MAP_GROWSDOWN, MAP_GROWSDOWN},
      // Typing into the terminal that the worker was started from.
      {SCMP_SYS(ioctl), EPERM, 1, SCMP_CMP_MASKED_EQ, kLow, TIOCSTI},
      {SCMP_SYS(ioctl), EPERM, 1, SCMP_CMP_MASKED_EQ, kLow, TIOCLINUX},
      // Landlock before its ABI 3 does not see that files are emptied.
      {SCMP_SYS(open), EACCES, 1, SCMP_CMP_MASKED_EQ, O_TRUNC, O_TRUNC},
      {SCMP_SYS(openat), EACCES, 2, SCMP_CMP_MASKED_EQ, O_TRUNC, O_TRUNC},
  }};
}

Error failure(const char* what, int error) {
  return Error{std::string("seccomp: ") + what + ": " + std::strerror(-error)};
}

}  // namespace

Status restrict_calls() {
  const std::unique_ptr<void, decltype(&seccomp_release)> filter(seccomp_init(SCMP_ACT_ALLOW),
                                                                 seccomp_release);
  if (filter == nullptr) return Error{"seccomp: no memory"};
  int error = seccomp_attr_set(filter.get(), SCMP_FLTATR_CTL_TSYNC, 1);
  for (const char* name : kForbidden) {
    const int call = seccomp_syscall_resolve_name(name);
    if (error != 0 || call == __NR_SCMP_ERROR) continue;
    error = seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(EPERM), call, 0);
  }
  for (const int call : kForbiddenNumbers) {
    if (error == 0) error = seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(EPERM), call, 0);
  }
  // What these are asked for lies in memory, which a filter cannot see: where they are not there,
  // the C library takes clone and openat.
  for (const int call : {SCMP_SYS(clone3), SCMP_SYS(openat2)}) {
    if (error == 0) error = seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), call, 0);
  }
  for (const Rule& rule : rules()) {
    const scmp_arg_cmp condition{rule.argument, rule.compare, rule.value, rule.mask};
    if (error != 0) break;
    error = seccomp_rule_add_array(filter.get(), SCMP_ACT_ERRNO(static_cast<uint16_t>(rule.error)),
                                   rule.call, 1, &condition);
  }
  if (error != 0) return failure("no rules", error);
  error = seccomp_load(filter.get());
  if (error != 0) return failure("not in this kernel, or refused", error);
  return {};
}

}  // namespace hyades::worker
