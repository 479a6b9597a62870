// What a scene that has taken over the process that renders it, or a picture's file the one that
// finishes it, would try against others on the machine. Each attack runs in a child of its own.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "coordinator/finisher/confine.h"
#include "core/base/hash.h"
#include "core/sandbox/private_root.h"
#include "farm/content_store.h"
#include "tests/support/temp_folder.h"
#include "worker/render/sandbox.h"

namespace hyades {
namespace {

constexpr int kNoSandbox = 99;

/// What `act` returns in a child of this process.
int in_child(const std::function<int()>& act) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(act());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 100;
}

bool refused(long result) {
  return result < 0 && (errno == EPERM || errno == EACCES || errno == ENOENT || errno == EROFS);
}

/// Runs attacks as the process that renders, and as the one that finishes.
class SandboxEscape : public ::testing::Test {
 protected:
  void SetUp() override {
    ::mkdir(cache_.c_str(), 0700);
    ::mkdir(folder_.file("scratch").c_str(), 0700);
    std::ofstream(cache_ + "/asset") << "bytes";
    std::ofstream(secret_) << "token";
    if (rendering([] { return true; }) == kNoSandbox) {
      GTEST_SKIP() << "this kernel has no Landlock, or no seccomp";
    }
  }
  int rendering(const std::function<bool()>& attack_fails) const {
    return in_child([&] {
      const auto lacks = worker::enter_sandbox(worker::SandboxMode::automatic, cache_, 10);
      return !lacks || !lacks->empty() ? kNoSandbox : attack_fails() ? 0 : 1;
    });
  }
  int finishing(const std::function<bool()>& attack_fails) const {
    return in_child([&] {
      const auto held = coordinator::confine_finisher(folder_.file("scratch"), folder_.file("out"));
      return !held ? kNoSandbox : attack_fails() ? 0 : 1;
    });
  }
  void fails(const std::function<bool()>& attack_fails) const {
    EXPECT_EQ(rendering(attack_fails), 0) << "from the process that renders";
    EXPECT_EQ(finishing(attack_fails), 0) << "from the process that finishes";
  }

  test::TempFolder folder_;
  const std::string cache_ = folder_.file("cache");
  const std::string secret_ = folder_.file("secret");
};

/// A process that waits until it is killed, which the test does in the end.
class Victim {
 public:
  Victim() : pid_(::fork()) {
    if (pid_ == 0) {
      ::pause();
      ::_exit(0);
    }
  }
  ~Victim() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  Victim(const Victim&) = delete;
  Victim& operator=(const Victim&) = delete;
  pid_t pid() const { return pid_; }
  bool lives() const {
    siginfo_t ended{};
    ::waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT);
    return ended.si_pid == 0;
  }

 private:
  const pid_t pid_;
};

TEST_F(SandboxEscape, SignalsNobodyByTheKernelsHand) {
  const Victim victim;
  fails([&] {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) return false;
    const bool owner = refused(::fcntl(ends[0], F_SETOWN, victim.pid()));
    const bool signal = refused(::fcntl(ends[0], F_SETSIG, SIGKILL));
    const bool async = refused(::fcntl(ends[0], F_SETFL, O_ASYNC));
    const int on = 1;
    const bool by_ioctl = refused(::ioctl(ends[0], 0x5452 /* FIOASYNC */, &on));
    (void)!::write(ends[1], "x", 1);
    return owner && signal && async && by_ioctl;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_TRUE(victim.lives());
}

TEST_F(SandboxEscape, SignalsNobodyItself) {
  const Victim victim;
  fails([&] {
    return refused(::kill(victim.pid(), SIGKILL)) && refused(::kill(-1, 0)) &&
           refused(::syscall(SYS_tgkill, victim.pid(), victim.pid(), SIGKILL)) &&
           refused(::syscall(SYS_pidfd_open, victim.pid(), 0));
  });
  EXPECT_TRUE(victim.lives());
}

TEST_F(SandboxEscape, ChangesNothingOfOthersFiles) {
  struct stat before {};
  ASSERT_EQ(::stat(secret_.c_str(), &before), 0);
  constexpr long kSetXattrAt = 463;
  fails([&] {
    const std::array<timeval, 2> long_ago{};
    return refused(::utimes(secret_.c_str(), long_ago.data())) &&
           refused(::syscall(kSetXattrAt, AT_FDCWD, secret_.c_str(), 0, "user.x", nullptr, 0)) &&
           refused(::chmod(secret_.c_str(), 0777)) && refused(::truncate(secret_.c_str(), 0)) &&
           refused(::unlink(secret_.c_str()));
  });
  struct stat after {};
  ASSERT_EQ(::stat(secret_.c_str(), &after), 0);
  EXPECT_EQ(after.st_mtim.tv_sec, before.st_mtim.tv_sec);
  EXPECT_EQ(after.st_mode, before.st_mode);
  EXPECT_EQ(after.st_size, before.st_size);
}

TEST_F(SandboxEscape, LocksNothing) {
  EXPECT_EQ(rendering([&] {
              const int file = ::open((cache_ + "/asset").c_str(), O_RDONLY);
              struct flock range {};
              range.l_type = F_RDLCK;
              return file >= 0 && refused(::flock(file, LOCK_SH)) &&
                     refused(::fcntl(file, F_SETLEASE, F_RDLCK)) &&
                     refused(::fcntl(file, F_SETLK, &range));
            }),
            0);
}

TEST_F(SandboxEscape, DoesNotEvenSeeOtherFiles) {
  const int hidden = in_child([&] {
    return core::hide_other_files({{cache_, core::FileAccess::read, true}}) ? 0 : 1;
  });
  if (hidden != 0) GTEST_SKIP() << "this machine allows no user namespaces";
  fails([&] {
    struct stat info {};
    return ::stat(secret_.c_str(), &info) != 0 && errno == ENOENT &&
           ::stat("/etc/passwd", &info) != 0 && errno == ENOENT;
  });
}

TEST_F(SandboxEscape, MakesNoConnections) {
  // Even through a socket that somebody has left open.
  const int open = ::socket(AF_INET, SOCK_STREAM, 0);
  ASSERT_GE(open, 0);
  ASSERT_EQ(::dup2(open, 9), 9);
  fails([] {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(9);
    const auto* to = reinterpret_cast<const sockaddr*>(&address);
    return refused(::socket(AF_INET, SOCK_STREAM, 0)) &&
           refused(::connect(9, to, sizeof address)) &&
           refused(::sendto(9, "x", 1, 0, to, sizeof address)) &&
           refused(::bind(9, to, sizeof address)) && refused(::listen(9, 1));
  });
  ::close(9);
  ::close(open);
}

/// What later kernels bring is refused until somebody has looked at it.
TEST_F(SandboxEscape, MakesNoCallsThatAreNotKnown) {
  fails([] {
    for (long call = 454; call < 600; ++call) {
      if (!refused(::syscall(call, 0, 0, 0, 0, 0, 0))) return false;
    }
    return true;
  });
}

TEST_F(SandboxEscape, StartsNoPrograms) {
  fails([] { return refused(::execl("/bin/true", "true", nullptr)) && refused(::fork()); });
}

/// Whoever may read a file of the cache may lock it and never let go.
TEST(SharedCache, ALockThatStaysIsAnErrorAndNotTheEnd) {
  test::TempFolder folder;
  const std::string name = core::to_hex(core::sha256("bytes"));
  auto store =
      farm::ContentStore::open({folder.file("cache"), 1U << 20U, std::chrono::milliseconds(200)});
  ASSERT_TRUE(store);
  std::ofstream(folder.file("cache/" + name)) << "bytes";
  const auto hold = [&](const std::string& path) {
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    EXPECT_EQ(::flock(file, LOCK_EX | LOCK_NB), 0);
    return file;
  };
  const int file = hold(folder.file("cache/" + name));
  const auto pin = (*store)->pin(name);
  ASSERT_FALSE(pin);
  EXPECT_NE(pin.error().message.find("another process has it"), std::string::npos)
      << pin.error().message;
  const int lock = hold(folder.file("cache/lock"));
  EXPECT_FALSE((*store)->write(core::to_hex(core::sha256("more")), 4));
  ::close(file);
  ::close(lock);
  EXPECT_TRUE((*store)->pin(name));
  EXPECT_TRUE((*store)->write(core::to_hex(core::sha256("more")), 4));
}

}  // namespace
}  // namespace hyades
