#include "coordinator/access/peer_user.h"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <linux/netlink.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>

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

const std::set<uid_t> kNobody;

TEST(PeerUser, IsWhoHoldsTheOtherEnd) {
  const std::set<uid_t> us{::geteuid()};
  const core::Descriptor listener = socket_at("127.0.0.1", 0, true);
  const std::set<std::string> ours{text_of(listener), "[::1]:" + port_of(listener)};
  core::Descriptor caller = socket_at("127.0.0.1", 0, false);
  const std::string peer = text_of(caller);
  EXPECT_EQ(users_of_peer(peer, ours), kNobody);
  ASSERT_TRUE(join(caller, listener));
  EXPECT_EQ(users_of_peer(peer, ours), us);
  EXPECT_EQ(users_of_peer(peer, {"127.0.0.1:1"}), kNobody) << "to another port";
  EXPECT_EQ(users_of_peer("127.0.0.1:1", ours), kNobody) << "from another port";
  EXPECT_EQ(users_of_peer("no address", ours), kNobody);
  caller.close();
  EXPECT_EQ(users_of_peer(peer, ours), kNobody) << "what nobody holds is nobody's, not root's";
}

/// Reading it for each who is refused, and has gone, would keep all others waiting. It would show
/// the connection whatever address of ours is named.
TEST(PeerUser, TheTableOfAllIsNotReadWhereTheKernelCanTell) {
  const core::Descriptor kernel(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
  if (!kernel.valid()) GTEST_SKIP() << "it cannot";
  const core::Descriptor listener = socket_at("0.0.0.0", 0, true);
  const core::Descriptor caller = socket_at("127.0.0.1", 0, false);
  ASSERT_TRUE(join(caller, listener));
  const std::string port = port_of(listener);
  EXPECT_EQ(users_of_peer(text_of(caller), {"127.0.0.2:" + port}), kNobody);
  EXPECT_EQ(users_of_peer(text_of(caller), {"0.0.0.0:" + port}), kNobody);
  EXPECT_EQ(users_of_peer(text_of(caller), {"127.0.0.1:" + port}), std::set{::geteuid()});
}

TEST(PeerUser, WhoTakesAnothersPortIsNotTakenForHim) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can be two users";
  const core::Descriptor one = socket_at("127.0.0.1", 0, true);
  const core::Descriptor two = socket_at("127.0.0.1", 0, true);
  const core::Descriptor caller = socket_at("127.0.0.1", 0, false);
  ASSERT_TRUE(join(caller, one));
  int told[2];
  ASSERT_EQ(::pipe(told), 0);
  const core::Descriptor done(told[0]);
  core::Descriptor begun(told[1]);
  const pid_t thief = ::fork();
  if (thief == 0) {
    if (::setuid(kAnother) != 0) ::_exit(1);
    const core::Descriptor his = socket_at("127.0.0.1", ntohs(place_of(caller).sin_port), false);
    if (join(his, two) && ::write(told[1], "x", 1) == 1) ::pause();
    ::_exit(1);
  }
  begun.close();
  char byte = 0;
  const bool stolen = ::read(done.get(), &byte, 1) == 1;
  EXPECT_EQ(users_of_peer(text_of(caller), {text_of(one), text_of(two)}),
            stolen ? (std::set<uid_t>{0, kAnother}) : std::set<uid_t>{0});
  EXPECT_TRUE(stolen);
  ::kill(thief, SIGKILL);
  ::waitpid(thief, nullptr, 0);
}

}  // namespace
}  // namespace hyades::coordinator
