// What a process may still do in the sandbox, and what not. Each case runs in a child of its own,
// as nobody gets out again.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <thread>

#include "core/base/hash.h"
#include "core/base/machine.h"
#include "core/base/process_limits.h"
#include "farm/content_store.h"
#include "tests/support/temp_folder.h"
#include "worker/render/sandbox.h"

namespace hyades::worker {
namespace {

constexpr unsigned kFirstClosed = 4;
constexpr int kNoSandbox = 99;

/// 0 where `check` holds in a sandbox around `cache`; kNoSandbox where the machine has none.
int in_sandbox(const std::string& cache, const std::function<bool()>& check) {
  const pid_t child = ::fork();
  if (child == 0) {
    const auto lacking = enter_sandbox(SandboxMode::automatic, cache, kFirstClosed);
    ::_exit(!lacking || !lacking->empty() ? kNoSandbox : check() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 100;
}

class Sandbox : public ::testing::Test {
 protected:
  void SetUp() override {
    ::mkdir(cache_.c_str(), 0700);
    std::ofstream(cache_ + "/asset") << "bytes";
    std::ofstream(folder_.file("secret")) << "token";
    if (in_sandbox(cache_, [] { return true; }) == kNoSandbox) {
      GTEST_SKIP() << "this kernel has no Landlock, or no seccomp";
    }
  }
  void expect(const std::function<bool()>& check) { EXPECT_EQ(in_sandbox(cache_, check), 0); }

  test::TempFolder folder_;
  const std::string cache_ = folder_.file("cache");
};

bool opens(const std::string& path, int flags) { return ::open(path.c_str(), flags, 0600) >= 0; }
bool refused(long result) {
  return result < 0 && (errno == EPERM || errno == EACCES || errno == EROFS || errno == ENOENT);
}

TEST_F(Sandbox, ReadsItsCache) {
  expect([&] { return opens(cache_ + "/asset", O_RDONLY); });
}

TEST_F(Sandbox, RemovesNothingOfOtherJobsAndNotTheWorkersId) {
  for (const char* name : {"/asset", "/worker-0.id", "/lock"}) {
    std::ofstream(cache_ + name) << "bytes";
    expect([&] { return refused(::unlink((cache_ + name).c_str())); });
    expect([&] { return refused(::rename((cache_ + name).c_str(), (cache_ + "/x").c_str())); });
  }
}

/// What it may not remove it tells of.
TEST_F(Sandbox, NamesFilesThatAreDamaged) {
  const std::string name = core::to_hex(core::sha256("good"));
  std::ofstream(cache_ + "/" + name) << "evil";
  ::mkdir((cache_ + "/partial").c_str(), 0700);
  expect([&] {
    auto store = farm::ContentStore::open({cache_, 0});
    if (!store) return false;
    const auto bytes = (*store)->read(name);
    return !bytes && bytes.error().message.ends_with("the stored file is damaged") &&
           (*store)->take_damaged() == std::set<std::string>{name} &&
           (*store)->take_damaged().empty();
  });
}

TEST_F(Sandbox, ReadsLibrariesAndWhatTheKernelTells) {
  expect([] { return opens("/proc/self/status", O_RDONLY) && opens("/usr/lib", O_RDONLY); });
}

TEST_F(Sandbox, OpensNoOtherFile) {
  expect([&] { return refused(::open(folder_.file("secret").c_str(), O_RDONLY)); });
  expect([] { return refused(::open("/etc/passwd", O_RDONLY)); });
  expect([&] { return refused(::open((cache_ + "/../secret").c_str(), O_RDONLY)); });
}

TEST_F(Sandbox, WritesNothing) {
  expect([&] { return refused(::open((cache_ + "/asset").c_str(), O_WRONLY)); });
  expect([&] { return refused(::open((cache_ + "/new").c_str(), O_WRONLY | O_CREAT, 0600)); });
  expect([&] { return refused(::truncate((cache_ + "/asset").c_str(), 0)); });
  expect([&] { return refused(::open((cache_ + "/asset").c_str(), O_RDONLY | O_TRUNC)); });
  expect([&] { return refused(::truncate(folder_.file("secret").c_str(), 0)); });
  expect([&] { return refused(::symlink("/etc/passwd", (cache_ + "/link").c_str())); });
  expect([&] { return refused(::mkdir((cache_ + "/folder").c_str(), 0700)); });
  expect([&] { return refused(::chmod((cache_ + "/asset").c_str(), 0777)); });
}

TEST_F(Sandbox, HasNoNetwork) {
  for (const int family : {AF_INET, AF_INET6, AF_UNIX, AF_NETLINK}) {
    expect([&] { return refused(::socket(family, SOCK_STREAM, 0)); });
  }
}

TEST_F(Sandbox, WhatIsOpenStaysOpenAndTheRestIsClosed) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  expect([&] {
    // In the child, after the sandbox: only what lies below kFirstClosed is open.
    return ::fcntl(static_cast<int>(kFirstClosed), F_GETFD) < 0 && errno == EBADF &&
           ::write(STDERR_FILENO, "", 0) == 0;
  });
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_F(Sandbox, StartsThreadsButNoProcesses) {
  expect([] {
    bool ran = false;
    std::thread([&] { ran = true; }).join();
    return ran;
  });
  expect([] { return ::fork() < 0; });
  expect([] { return refused(::execl("/bin/true", "true", nullptr)); });
  expect([] {
    pid_t pid = 0;
    std::string name = "true";
    std::array<char*, 2> words{name.data(), nullptr};
    return ::posix_spawn(&pid, "/bin/true", nullptr, nullptr, words.data(), environ) != 0;
  });
}

TEST_F(Sandbox, HoldsThreadsThatItStarts) {
  expect([&] {
    bool held = false;
    std::thread([&] {
      held = !opens(folder_.file("secret"), O_RDONLY) && ::socket(AF_INET, SOCK_STREAM, 0) < 0;
    }).join();
    return held;
  });
}

TEST_F(Sandbox, TypesIntoNoTerminal) {
  expect([] {
    char letter = 'x';
    return ::ioctl(STDIN_FILENO, TIOCSTI, &letter) < 0 && errno == EPERM;
  });
}

TEST_F(Sandbox, ItsOwnSignalsAndLimitsStay) {
  expect([] {
    ::signal(SIGUSR1, SIG_IGN);
    rlimit cores{};
    return ::raise(SIGUSR1) == 0 && ::getrlimit(RLIMIT_CORE, &cores) == 0;
  });
}

TEST_F(Sandbox, TouchesNoOtherProcess) {
  expect([] { return refused(::kill(::getppid(), 0)); });
  const pid_t runner = ::getpid();  // the child's parent
  expect([&] { return refused(::syscall(SYS_tkill, runner, 0)); });
  expect([&] { return refused(::syscall(SYS_tgkill, runner, runner, 0)); });
  expect([&] { return refused(::syscall(SYS_prlimit64, runner, RLIMIT_CORE, nullptr, nullptr)); });
  expect([&] {
    return refused(::open(("/proc/" + std::to_string(runner) + "/cmdline").c_str(), O_RDONLY));
  });
  expect([] { return refused(::ptrace(PTRACE_ATTACH, ::getppid(), nullptr, nullptr)); });
  const cpu_set_t one = [] {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(0, &set);
    return set;
  }();
  const sched_param none{};
  expect([&] { return refused(::sched_setaffinity(runner, sizeof one, &one)); });
  expect([&] { return refused(::sched_setscheduler(runner, SCHED_BATCH, &none)); });
  expect([&] { return refused(::sched_setparam(runner, &none)); });
  expect([&] { return refused(::syscall(SYS_sched_setattr, runner, nullptr, 0)); });
  expect([&] { return refused(::setpriority(PRIO_PROCESS, static_cast<id_t>(runner), 19)); });
  expect([&] { return refused(::setpriority(PRIO_USER, 0, 19)); });
  expect([&] { return refused(::syscall(SYS_ioprio_set, 1, runner, 0)); });
  expect([&] { return refused(::syscall(SYS_migrate_pages, runner, 0, nullptr, nullptr)); });
  expect(
      [&] { return refused(::syscall(SYS_move_pages, runner, 0, nullptr, nullptr, nullptr, 0)); });
  expect([] { return refused(::shmctl(0, IPC_RMID, nullptr)); });
  expect([] { return refused(::unshare(CLONE_NEWUSER)); });
  expect([] { return refused(::syscall(SYS_bpf, 0, nullptr, 0)); });
}

/// Whoever starts the worker may refuse it these calls: the lists of systemd 252 and of old
/// container engines do.
TEST_F(Sandbox, WhereTheCallsForItAreRefusedItIsLackingAndTheWayOutIsTold) {
  const auto refuses = [] {
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
    const int call = seccomp_syscall_resolve_name("landlock_create_ruleset");
    const bool held = ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
                      seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), call, 0) == 0 &&
                      seccomp_load(filter) == 0;
    seccomp_release(filter);
    return held;
  };
  const auto in_child = [&](SandboxMode mode, const std::function<bool(const std::string&)>& says) {
    const pid_t child = ::fork();
    if (child == 0) {
      if (!refuses()) ::_exit(2);
      const auto entered = enter_sandbox(mode, cache_, kFirstClosed);
      ::_exit(says(entered ? *entered : "error: " + entered.error().message) ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 100;
  };
  EXPECT_EQ(in_child(SandboxMode::automatic,
                     [](const std::string& text) { return text.starts_with("Landlock: "); }),
            0);
  EXPECT_EQ(in_child(SandboxMode::required,
                     [](const std::string& text) {
                       return text.starts_with("error: this machine has no whole sandbox") &&
                              text.find("'auto' instead of 'require'") != std::string::npos;
                     }),
            0);
}

/// RLIMIT_DATA counts none of these.
TEST_F(Sandbox, TakesNoMemoryThatIsNotCounted) {
  const auto takes = [](int flags) {
    return ::mmap(nullptr, 1U << 20U, PROT_READ | PROT_WRITE, flags, -1, 0) != MAP_FAILED;
  };
  ASSERT_TRUE(takes(MAP_SHARED | MAP_ANONYMOUS));
  ASSERT_TRUE(takes(MAP_PRIVATE | MAP_ANONYMOUS | MAP_GROWSDOWN));
  expect([&] { return takes(MAP_PRIVATE | MAP_ANONYMOUS); });
  expect([&] { return !takes(MAP_SHARED | MAP_ANONYMOUS) && errno == EPERM; });
  expect([&] { return !takes(MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE) && errno == EPERM; });
  expect([&] {
    return !takes(MAP_PRIVATE | MAP_ANONYMOUS | MAP_GROWSDOWN | MAP_NORESERVE) && errno == EPERM;
  });
  expect([] { return refused(::memfd_create("memory", 0)); });
  constexpr long kMemfdSecret = 447;
  expect([] { return ::syscall(kMemfdSecret, 0) < 0; });
}

TEST_F(Sandbox, FilesThatAreOpenTakeTexels) {
  std::ofstream(folder_.file("texels")) << std::string(5000, 'x');
  const int before = ::open(folder_.file("texels").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::dup2(before, kFirstClosed - 1), static_cast<int>(kFirstClosed - 1));
  expect([] {
    const int file = kFirstClosed - 1;
    if (::posix_fallocate(file, 4096, 8192) != 0 || ::pwrite(file, "yy", 2, 4096) != 2)
      return false;
    const void* at = ::mmap(nullptr, 4096, PROT_READ, MAP_SHARED, file, 4096);
    return at != MAP_FAILED && *static_cast<const char*>(at) == 'y';
  });
  ::close(before);
  ::close(kFirstClosed - 1);
}

/// Room behind a file's end would not count.
TEST_F(Sandbox, FilesThatAreOpenTakeNoMoreRoomThanTheyMay) {
  std::ofstream(folder_.file("texels")) << "x";
  const int before = ::open(folder_.file("texels").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::dup2(before, kFirstClosed - 1), static_cast<int>(kFirstClosed - 1));
  expect([] {
    const int file = kFirstClosed - 1;
    core::ignore_file_size_signal();
    if (!core::limit_file_size(1U << 20U)) return false;
    if (::posix_fallocate(file, 0, 1U << 20U) != 0) return false;
    if (::fallocate(file, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, 4096) != 0) return false;
    return ::posix_fallocate(file, 0, 2U << 20U) == EFBIG &&
           ::fallocate(file, FALLOC_FL_KEEP_SIZE, 0, 2U << 20U) != 0 && errno == EPERM &&
           ::pwrite(file, "y", 1, 2U << 20U) < 0 && errno == EFBIG;
  });
  ::close(before);
  ::close(kFirstClosed - 1);
}

TEST_F(Sandbox, ThreadsMayTieThemselvesToProcessors) {
  expect([] {
    cpu_set_t set;
    return ::sched_getaffinity(0, sizeof set, &set) == 0 &&
           ::sched_setaffinity(0, sizeof set, &set) == 0;
  });
}

TEST(ProcessMemory, IsTheFirstToGoAndNoLessThanItWas) {
  const auto score_after = [](const std::function<bool()>& act) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(act() ? 0 : 1);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  };
  const auto score = [] {
    int value = 0;
    std::ifstream("/proc/self/oom_score_adj") >> value;
    return value;
  };
  EXPECT_TRUE(score_after([&] { return core::go_first() && score() >= 800; }));
  EXPECT_TRUE(score_after([&] {
    std::ofstream("/proc/self/oom_score_adj") << 950 << std::flush;
    return core::go_first() && score() == 950;
  }));
}

TEST(ProcessMemory, StacksHaveALimitToo) {
  const pid_t child = ::fork();
  if (child == 0) {
    rlimit stack{};
    const bool held = core::limit_memory(uint64_t{1} << 33U) &&
                      ::getrlimit(RLIMIT_STACK, &stack) == 0 &&
                      stack.rlim_max <= uint64_t{64} << 20U;
    ::_exit(held ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(SandboxMode, IsOneOfThreeWords) {
  EXPECT_EQ(*read_sandbox_mode("require"), SandboxMode::required);
  EXPECT_EQ(*read_sandbox_mode("auto"), SandboxMode::automatic);
  EXPECT_EQ(read_sandbox_mode("on").error().message, "'on': expected auto, require or off");
}

}  // namespace
}  // namespace hyades::worker
