#include "core/sandbox/call_filter.h"

#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>

namespace hyades::core {
namespace {

/// Whatever the arguments are. Names that this machine's library does not know are left out.
constexpr const char* kRender[] = {
    // files that are open, and opening others, as Landlock lets it
    "read", "readv", "pread64", "preadv", "write", "writev", "pwrite64", "pwritev", "lseek",
    "close", "close_range", "dup", "dup2", "dup3", "fstat", "newfstatat", "stat", "lstat", "statx",
    "statfs", "fstatfs", "access", "faccessat", "faccessat2", "readlink", "readlinkat", "getcwd",
    "getdents64", "ftruncate", "fadvise64", "fsync", "fdatasync", "pipe", "pipe2", "eventfd2",
    "poll", "ppoll", "select", "pselect6", "recvfrom", "shutdown",
    // memory
    "brk", "munmap", "mremap", "mprotect", "madvise", "msync", "mincore", "membarrier",
    "get_mempolicy",
    // threads
    "futex", "set_robust_list", "rseq", "set_tid_address", "gettid", "exit", "exit_group",
    "sched_yield", "sched_getaffinity", "sched_getparam", "sched_getscheduler",
    "sched_get_priority_min", "sched_get_priority_max", "getcpu", "arch_prctl", "restart_syscall",
    // signals to oneself
    "rt_sigaction", "rt_sigprocmask", "rt_sigreturn", "rt_sigpending", "rt_sigsuspend",
    "rt_sigtimedwait", "sigaltstack", "pause",
    // time
    "clock_gettime", "clock_getres", "clock_nanosleep", "nanosleep", "gettimeofday", "time",
    "times",
    // what it is and has
    "getpid", "getppid", "getuid", "geteuid", "getgid", "getegid", "getresuid", "getresgid",
    "getgroups", "getpgrp", "getpgid", "capget", "umask", "uname", "sysinfo", "getrlimit",
    "getrusage", "getpriority", "getrandom"};
constexpr const char* kFinish[] = {"mkdir",           "mkdirat",  "rename",   "renameat",
                                   "renameat2",       "unlink",   "unlinkat", "rmdir",
                                   "copy_file_range", "sendfile", "symlink",  "chdir"};
constexpr const char* kEncode[] = {"execve", "fork",    "vfork", "wait4",
                                   "waitid", "setpgid", "mlock", "munlock"};

/// A call that is allowed where its argument number `argument`, under `mask`, is `value`.
struct Allowed {
  int call;
  unsigned argument;
  uint64_t mask;
  uint64_t value;
};

constexpr uint64_t kWhole = ~uint64_t{0};
constexpr uint64_t kNamespaces = CLONE_NEWNS | CLONE_NEWCGROUP | CLONE_NEWUTS | CLONE_NEWIPC |
                                 CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNET;

class Filter {
 public:
  Filter() : context_(seccomp_init(SCMP_ACT_ERRNO(EPERM)), seccomp_release) {
    if (context_ == nullptr) error_ = -ENOMEM;
    note(error_ != 0 ? error_ : seccomp_attr_set(context_.get(), SCMP_FLTATR_CTL_TSYNC, 1));
  }

  void allow(std::span<const char* const> names) {
    for (const char* name : names) {
      const int call = seccomp_syscall_resolve_name(name);
      if (call != __NR_SCMP_ERROR && error_ == 0) {
        note(seccomp_rule_add_array(context_.get(), SCMP_ACT_ALLOW, call, 0, nullptr));
      }
    }
  }
  void allow(std::initializer_list<Allowed> some) {
    for (const Allowed& one : some) {
      const scmp_arg_cmp condition{one.argument, SCMP_CMP_MASKED_EQ, one.mask, one.value};
      if (error_ == 0) {
        note(seccomp_rule_add_array(context_.get(), SCMP_ACT_ALLOW, one.call, 1, &condition));
      }
    }
  }
  void refuse(int call, uint16_t error) {
    if (error_ == 0) {
      note(seccomp_rule_add_array(context_.get(), SCMP_ACT_ERRNO(error), call, 0, nullptr));
    }
  }

  Status load() {
    if (error_ != 0) return failure("no rules", error_);
    error_ = seccomp_load(context_.get());
    return error_ != 0 ? failure("not in this kernel, or refused", error_) : Status{};
  }

 private:
  static Error failure(const char* what, int error) {
    return Error{std::string("seccomp: ") + what + ": " + std::strerror(-error)};
  }
  void note(int error) { error_ = error; }

  const std::unique_ptr<void, decltype(&seccomp_release)> context_;
  int error_ = 0;
};

/// What all need of calls that could do more.
void allow_some(Filter& filter) {
  const auto own = static_cast<uint64_t>(::getpid());
  constexpr int kFcntl = SCMP_SYS(fcntl);
  filter.allow({
      // Not F_SETOWN and F_SETSIG, by which the kernel signals others, nor leases and locks.
      {kFcntl, 1, kWhole, F_DUPFD},
      {kFcntl, 1, kWhole, F_DUPFD_CLOEXEC},
      {kFcntl, 1, kWhole, F_GETFD},
      {kFcntl, 1, kWhole, F_SETFD},
      {kFcntl, 1, kWhole, F_GETFL},
      // Whether a terminal is there, how wide it is, and how much can be read.
      {SCMP_SYS(ioctl), 1, kWhole, TCGETS},
      {SCMP_SYS(ioctl), 1, kWhole, TIOCGWINSZ},
      {SCMP_SYS(ioctl), 1, kWhole, FIONREAD},
      // Not room beyond a file's end (KEEP_SIZE alone), which RLIMIT_FSIZE does not count.
      {SCMP_SYS(fallocate), 1, kWhole, 0},
      {SCMP_SYS(fallocate), 1, kWhole, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE},
      // Not to an address.
      {SCMP_SYS(sendto), 4, kWhole, 0},
      // abort() and raise() signal one's own threads; limits are asked and set for oneself.
      {SCMP_SYS(tgkill), 0, kWhole, own},
      {SCMP_SYS(prlimit64), 0, kWhole, 0},
      // The calling thread's own, for libraries that tie threads to processors.
      {SCMP_SYS(sched_setaffinity), 0, kWhole, 0},
      {SCMP_SYS(prctl), 0, kWhole, PR_SET_NAME},
      {SCMP_SYS(prctl), 0, kWhole, PR_GET_NAME},
      {SCMP_SYS(prctl), 0, kWhole, PR_SET_VMA},
  });
  // What these are asked for lies in memory, which a filter cannot see.
  filter.refuse(SCMP_SYS(clone3), ENOSYS);
  filter.refuse(SCMP_SYS(openat2), ENOSYS);
}

/// What a renderer opens it does not empty, which Landlock sees from its ABI 3 on only; and it maps
/// no memory that RLIMIT_DATA does not count, as it belongs to no process alone, or to a stack.
void allow_render(Filter& filter) {
  constexpr uint64_t kKind = MAP_SHARED | MAP_ANONYMOUS | MAP_GROWSDOWN;
  filter.allow({
      {SCMP_SYS(clone), 0, CLONE_THREAD, CLONE_THREAD},
      {SCMP_SYS(open), 1, O_TRUNC, 0},
      {SCMP_SYS(openat), 2, O_TRUNC, 0},
      {SCMP_SYS(mmap), 3, kKind, 0},
      {SCMP_SYS(mmap), 3, kKind, MAP_SHARED},
      {SCMP_SYS(mmap), 3, kKind, MAP_ANONYMOUS},
  });
}

}  // namespace

Status allow_calls(AllowedCalls allowed) {
  Filter filter;
  filter.allow(kRender);
  allow_some(filter);
  if (allowed == AllowedCalls::render) {
    allow_render(filter);
    return filter.load();
  }
  filter.allow(kFinish);
  filter.allow(std::initializer_list<const char*>{"open", "openat", "creat", "mmap"});
  if (allowed == AllowedCalls::finish) {
    filter.allow({{SCMP_SYS(clone), 0, CLONE_THREAD, CLONE_THREAD}});
  } else {
    filter.allow(kEncode);
    filter.allow({{SCMP_SYS(clone), 0, kNamespaces, 0}});
  }
  return filter.load();
}

}  // namespace hyades::core
