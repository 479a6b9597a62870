#include "coordinator/access/peer_user.h"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/netlink.h>
#include <linux/seccomp.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/descriptor.h"

namespace hyades::coordinator {
namespace {

constexpr uid_t kAnother = 65534;

/// A socket of this machine, whose port others may share.
core::Descriptor socket_at(const char* host, uint16_t port, bool listens) {
  core::Descriptor made(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int yes = 1;
  ::setsockopt(made.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_port = htons(port);
  ::inet_pton(AF_INET, host, &own.sin_addr);
  EXPECT_EQ(::bind(made.get(), reinterpret_cast<sockaddr*>(&own), sizeof own), 0);
  EXPECT_TRUE(!listens || ::listen(made.get(), 8) == 0);
  return made;
}

sockaddr_in place_of(const core::Descriptor& socket) {
  sockaddr_in place{};
  socklen_t size = sizeof place;
  ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&place), &size);
  return place;
}

std::string port_of(const core::Descriptor& socket) {
  return std::to_string(ntohs(place_of(socket).sin_port));
}

std::string text_of(const core::Descriptor& socket) { return "127.0.0.1:" + port_of(socket); }

bool join(const core::Descriptor& caller, const core::Descriptor& listener) {
  sockaddr_in to = place_of(listener);
  if (to.sin_addr.s_addr == INADDR_ANY) to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return ::connect(caller.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
}

core::Descriptor accepted(const core::Descriptor& listener) {
  return core::Descriptor(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC));
}

bool bind_to_loopback(const core::Descriptor& socket) {
  return ::setsockopt(socket.get(), SOL_SOCKET, SO_BINDTODEVICE, "lo", 2) == 0;
}

/// Ends a connection without a farewell.
void reset(core::Descriptor& socket) {
  const linger at_once{1, 0};
  ::setsockopt(socket.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  socket.close();
}

/// What this thread makes meanwhile is another user's.
class AsAnother {
 public:
  AsAnother() { EXPECT_EQ(::seteuid(kAnother), 0); }
  ~AsAnother() { EXPECT_EQ(::seteuid(0), 0); }
  AsAnother(const AsAnother&) = delete;
  AsAnother& operator=(const AsAnother&) = delete;
};

/// From now on this process may not make this call, with this first argument: it ends, or is told
/// that there is no such thing.
bool forbid(uint32_t call, uint32_t first, uint32_t action) {
  std::array<sock_filter, 6> program{{
      {BPF_LD | BPF_W | BPF_ABS, 0, 0, offsetof(seccomp_data, nr)},
      {BPF_JMP | BPF_JEQ | BPF_K, 0, 3, call},
      {BPF_LD | BPF_W | BPF_ABS, 0, 0, offsetof(seccomp_data, args)},
      {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, first},
      {BPF_RET | BPF_K, 0, 0, action},
      {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ALLOW},
  }};
  const sock_fprog filter{program.size(), program.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

/// As in a container that may not ask the kernel for connections.
bool forbid_questions() { return forbid(SYS_socket, AF_NETLINK, SECCOMP_RET_ERRNO | EAFNOSUPPORT); }
bool forbid_files() {
  return forbid(SYS_openat, static_cast<uint32_t>(AT_FDCWD), SECCOMP_RET_KILL);
}

/// What user_of_peer() tells a process that has forbidden itself something; 1 where it cannot tell.
std::optional<uid_t> told_to(bool (*forbids)(), const std::string& peer, const std::string& own) {
  constexpr int kOfNobody = 100;
  constexpr int kOfAnother = 101;
  const pid_t child = ::fork();
  if (child == 0) {
    if (!forbids()) ::_exit(1);
    const auto user = user_of_peer(peer, own);
    ::_exit(!user ? kOfNobody : *user == kAnother ? kOfAnother : *user == ::geteuid() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  const int told = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  if (told == kOfNobody) return std::nullopt;
  return told == kOfAnother ? kAnother : told == 0 ? ::geteuid() : 1;
}

constexpr std::nullopt_t kNobody = std::nullopt;

/// Ends that no process holds are open, and until Linux 6.16 they count as root's: one that is not
/// accepted yet, or one that close() leaves open (MPTCP).
TEST(PeerUser, OfEndsThatNobodyHoldsIsNobody) {
  const core::Descriptor listener = socket_at("127.0.0.1", 0, true);
  const core::Descriptor caller = socket_at("127.0.0.1", 0, false);
  ASSERT_TRUE(join(caller, listener));
  const std::string not_accepted = text_of(listener);
  EXPECT_EQ(user_of_peer(not_accepted, text_of(caller)), kNobody);
  EXPECT_EQ(told_to(forbid_questions, not_accepted, text_of(caller)), kNobody);
  const core::Descriptor other = accepted(listener);
  EXPECT_EQ(user_of_peer(not_accepted, text_of(caller)), ::geteuid());
  EXPECT_EQ(told_to(forbid_questions, not_accepted, text_of(caller)), ::geteuid());
}

/// A user namespace in which our own user has the number that all others have there.
bool become_one_of_many() {
  if (::unshare(CLONE_NEWUSER) != 0) return false;
  const core::Descriptor map(::open("/proc/self/uid_map", O_WRONLY | O_CLOEXEC));
  const std::string line = std::to_string(kAnother) + " 0 1";
  return ::write(map.get(), line.data(), line.size()) == static_cast<ssize_t>(line.size());
}

TEST(PeerUser, OfManyUsersIsNobody) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can be two users";
  const core::Descriptor listener = socket_at("127.0.0.1", 0, true);
  const auto another = [&] {
    const AsAnother as;
    core::Descriptor caller = socket_at("127.0.0.1", 0, false);
    EXPECT_TRUE(join(caller, listener));
    return caller;
  }();
  const std::string peer = text_of(another);
  EXPECT_EQ(user_of_peer(peer, text_of(listener)), kAnother);
  const auto told = told_to(become_one_of_many, peer, text_of(listener));
  if (told == uid_t{1}) GTEST_SKIP() << "no user namespaces here";
  EXPECT_EQ(told, kNobody);
}

TEST(PeerUser, NeighboursOfThisMachineAreItsUsers) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can be two users";
  const core::Descriptor listener = socket_at("0.0.0.0", 0, true);
  const auto neighbour = [&](const char* from, bool another) {
    std::optional<AsAnother> as;
    if (another) as.emplace();
    const core::Descriptor caller = socket_at(from, 0, false);
    as.reset();
    EXPECT_TRUE(join(caller, listener));
    return neighbour_at(from + (":" + port_of(caller)), accepted(listener).get());
  };
  EXPECT_TRUE(neighbour("127.0.0.1", false).is_own_user);
  EXPECT_NE(neighbour("127.0.0.1", false).name, neighbour("127.0.0.2", false).name);
  EXPECT_FALSE(neighbour("127.0.0.1", true).is_own_user);
  EXPECT_EQ(neighbour("127.0.0.1", true).name, neighbour("127.0.0.2", true).name)
      << "he has all addresses of this machine";
  EXPECT_NE(neighbour("127.0.0.1", true).name, neighbour("127.0.0.1", false).name);
  EXPECT_NE(neighbour("127.0.0.1", true).group, "");
  EXPECT_EQ(neighbour("127.0.0.1", false).group, "");
}

TEST(PeerUser, IsWhoHoldsTheOtherEnd) {
  const core::Descriptor listener = socket_at("127.0.0.1", 0, true);
  const std::string own = text_of(listener);
  core::Descriptor caller = socket_at("127.0.0.1", 0, false);
  const std::string peer = text_of(caller);
  EXPECT_EQ(user_of_peer(peer, own), kNobody);
  ASSERT_TRUE(join(caller, listener));
  EXPECT_EQ(user_of_peer(peer, own), ::geteuid());
  EXPECT_EQ(user_of_peer(peer, "127.0.0.1:1"), kNobody) << "to another port";
  EXPECT_EQ(user_of_peer(peer, "[::1]:" + port_of(listener)), kNobody) << "to another address";
  EXPECT_EQ(user_of_peer("127.0.0.1:1", own), kNobody) << "from another port";
  EXPECT_EQ(user_of_peer("no address", own), kNobody);
  EXPECT_EQ(user_of_peer(peer, ""), kNobody);
  caller.close();
  EXPECT_EQ(user_of_peer(peer, own), kNobody) << "what nobody holds is nobody's, not root's";
}

TEST(PeerUser, IsToldOfWhoIsBoundToTheDevice) {
  const core::Descriptor listener = socket_at("127.0.0.1", 0, true);
  const core::Descriptor caller = socket_at("127.0.0.1", 0, false);
  if (!bind_to_loopback(caller)) GTEST_SKIP() << "only root may bind a socket to a device";
  ASSERT_TRUE(join(caller, listener));
  EXPECT_EQ(user_of_peer(text_of(caller), text_of(listener)), ::geteuid());
}

/// Reading it for each who is refused, and has gone, would keep all others waiting.
TEST(PeerUser, TheTableOfAllIsNotReadWhereTheKernelCanTell) {
  const core::Descriptor kernel(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
  if (!kernel.valid()) GTEST_SKIP() << "it cannot";
  EXPECT_EQ(told_to(forbid_files, "127.0.0.1:1", "127.0.0.1:2"), kNobody);
  EXPECT_EQ(told_to(forbid_files, "[::1]:1", "[::1]:2"), kNobody);
}

TEST(PeerUser, TheTableTellsWhereTheKernelMayNotBeAsked) {
  const core::Descriptor listener = socket_at("0.0.0.0", 0, true);
  const core::Descriptor caller = socket_at("127.0.0.1", 0, false);
  ASSERT_TRUE(join(caller, listener));
  const std::string peer = text_of(caller);
  EXPECT_EQ(told_to(forbid_questions, peer, text_of(listener)), ::geteuid());
  EXPECT_EQ(told_to(forbid_questions, peer, "127.0.0.2:" + port_of(listener)), kNobody);
  EXPECT_EQ(told_to(forbid_questions, peer, "127.0.0.1:1"), kNobody);
}

/// A thief has the port of root's connection to one of our addresses, and calls at the other: that
/// he hides his own end must not make him root there.
class ThiefOfAPort : public testing::Test {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can be two users";
    ASSERT_TRUE(join(owner, one));
    ASSERT_EQ(user_of_peer(text_of(owner), text_of(one)), 0U);
  }
  /// The thief connects, bound to the device where he may.
  void steal(bool bound) {
    const AsAnother now;
    his = socket_at("127.0.0.1", ntohs(place_of(owner).sin_port), false);
    if (bound && !bind_to_loopback(his)) GTEST_SKIP() << "he may not";
    ASSERT_TRUE(join(his, two));
  }
  std::optional<uid_t> at_two() const { return user_of_peer(text_of(owner), text_of(two)); }
  /// ... by the table of all connections.
  std::optional<uid_t> at_two_by_table() const {
    return told_to(forbid_questions, text_of(owner), text_of(two));
  }

  const core::Descriptor one = socket_at("127.0.0.1", 0, true);
  const core::Descriptor two = socket_at("127.0.0.1", 0, true);
  const core::Descriptor owner = socket_at("127.0.0.1", 0, false);
  core::Descriptor his;
};

TEST_F(ThiefOfAPort, IsHimself) {
  steal(false);
  EXPECT_EQ(at_two(), kAnother);
  EXPECT_EQ(at_two_by_table(), kAnother);
  EXPECT_EQ(user_of_peer(text_of(owner), text_of(one)), 0U) << "and the owner stays one";
}

TEST_F(ThiefOfAPort, IsHimselfBoundToTheDevice) {
  steal(true);
  EXPECT_EQ(at_two(), kAnother);
  EXPECT_EQ(at_two_by_table(), kAnother);
}

TEST_F(ThiefOfAPort, IsNobodyHalfClosed) {
  for (const bool bound : {false, true}) {
    steal(bound);
    ::shutdown(his.get(), SHUT_WR);
    EXPECT_EQ(at_two(), kNobody) << bound;
    EXPECT_EQ(at_two_by_table(), kNobody) << bound;
    reset(his);
  }
}

TEST_F(ThiefOfAPort, IsNobodyOnceHeHasGone) {
  steal(false);
  reset(his);
  EXPECT_EQ(at_two(), kNobody) << "reset";
  EXPECT_EQ(at_two_by_table(), kNobody) << "reset";
  steal(false);
  his.close();
  EXPECT_EQ(at_two(), kNobody) << "closed";
  EXPECT_EQ(at_two_by_table(), kNobody) << "closed";
}

TEST(OwnEnd, IsWhereTheConnectionCameInWhileItIsOpen) {
  const core::Descriptor listener = socket_at("0.0.0.0", 0, true);
  core::Descriptor caller = socket_at("127.0.0.1", 0, false);
  ASSERT_TRUE(join(caller, listener));
  const core::Descriptor ours = accepted(listener);
  EXPECT_EQ(own_end(ours.get()), text_of(listener)) << "at one address of all";
  ::shutdown(caller.get(), SHUT_WR);
  EXPECT_EQ(own_end(ours.get()), "");
  caller = socket_at("127.0.0.1", 0, false);
  ASSERT_TRUE(join(caller, listener));
  const core::Descriptor other = accepted(listener);
  EXPECT_EQ(own_end(other.get()), text_of(listener));
  reset(caller);
  EXPECT_EQ(own_end(other.get()), "");
  EXPECT_EQ(own_end(-1), "");
}

}  // namespace
}  // namespace hyades::coordinator
