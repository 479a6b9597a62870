#include "worker/render/sandbox_calls.h"

#include <sched.h>
#include <seccomp.h>

#include <array>
#include <cerrno>
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
    "execve", "execveat", "fork", "vfork", "kill", "pidfd_open", "pidfd_getfd", "pidfd_send_signal",
    "ptrace", "process_vm_readv", "process_vm_writev", "process_madvise", "kcmp", "setns",
    "unshare", "shmget", "shmat", "msgget", "semget", "mq_open",
    // the file system, where Landlock does not reach
    "mount", "umount2", "pivot_root", "chroot", "fsopen", "fsmount", "move_mount", "open_tree",
    "open_by_handle_at", "name_to_handle_at", "quotactl", "swapon", "swapoff", "chmod", "fchmod",
    "fchmodat", "chown", "fchown", "lchown", "fchownat", "setxattr", "lsetxattr", "fsetxattr",
    "mknod", "mknodat", "fanotify_init",
    // the kernel itself
    "bpf", "perf_event_open", "userfaultfd", "io_uring_setup", "io_uring_enter",
    "io_uring_register", "keyctl", "add_key", "request_key", "init_module", "finit_module",
    "delete_module", "kexec_load", "kexec_file_load", "reboot", "acct", "syslog", "settimeofday",
    "clock_settime", "clock_adjtime", "adjtimex", "sethostname", "setdomainname", "iopl", "ioperm",
    "personality", "modify_ldt", "vhangup", "nfsservctl", "lookup_dcookie", "uselib", "ustat",
    "sysfs", "setuid", "setgid", "setreuid", "setregid", "setresuid", "setresgid", "setgroups",
    "setfsuid", "setfsgid", "capset"};

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
  // Threads are made by clone, processes too. What clone3 makes cannot be seen by a filter: where
  // it is not there, the C library takes clone.
  if (error == 0) {
    error = seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
  }
  if (error == 0) {
    error = seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(EPERM), SCMP_SYS(clone), 1,
                             SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, 0));
  }
  if (error != 0) return failure("no rules", error);
  error = seccomp_load(filter.get());
  if (error != 0) return failure("not in this kernel, or refused", error);
  return {};
}

}  // namespace hyades::worker
