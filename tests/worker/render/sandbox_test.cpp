// What a process may still do in the sandbox, and what not. Each case runs in a child of its own,
// as nobody gets out again.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <functional>
#include <thread>

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
bool refused(long result) { return result < 0 && (errno == EPERM || errno == EACCES); }

TEST_F(Sandbox, ReadsItsCacheAndRemovesWhatIsDamaged) {
  expect([&] { return opens(cache_ + "/asset", O_RDONLY); });
  expect([&] { return ::unlink((cache_ + "/asset").c_str()) == 0; });
}

TEST_F(Sandbox, ReadsLibrariesAndWhatTheKernelTells) {
  expect([] { return opens("/proc/self/status", O_RDONLY) && opens("/usr/lib", O_RDONLY); });
}

TEST_F(Sandbox, OpensNoOtherFile) {
  expect([&] { return !opens(folder_.file("secret"), O_RDONLY) && errno == EACCES; });
  expect([] { return !opens("/etc/passwd", O_RDONLY) && errno == EACCES; });
  expect([&] { return !opens(cache_ + "/../secret", O_RDONLY) && errno == EACCES; });
}

TEST_F(Sandbox, WritesNothing) {
  expect([&] { return !opens(cache_ + "/asset", O_WRONLY) && errno == EACCES; });
  expect([&] { return !opens(cache_ + "/new", O_WRONLY | O_CREAT) && errno == EACCES; });
  expect([&] { return refused(::truncate((cache_ + "/asset").c_str(), 0)); });
  expect([&] { return !opens(cache_ + "/asset", O_RDONLY | O_TRUNC) && errno == EACCES; });
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
    return !opens("/proc/" + std::to_string(runner) + "/cmdline", O_RDONLY) && errno == EACCES;
  });
  expect([] { return refused(::ptrace(PTRACE_ATTACH, ::getppid(), nullptr, nullptr)); });
  expect([] { return refused(::unshare(CLONE_NEWUSER)); });
  expect([] { return refused(::syscall(SYS_bpf, 0, nullptr, 0)); });
}

TEST(SandboxMode, IsOneOfThreeWords) {
  EXPECT_EQ(*read_sandbox_mode("require"), SandboxMode::required);
  EXPECT_EQ(*read_sandbox_mode("auto"), SandboxMode::automatic);
  EXPECT_EQ(read_sandbox_mode("on").error().message, "'on': expected auto, require or off");
}

}  // namespace
}  // namespace hyades::worker
