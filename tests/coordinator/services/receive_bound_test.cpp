#include "coordinator/services/receive_bound.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>

#include "coordinator/access/listening.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

/// A connection of this machine with itself, over a family of addresses.
class ReceiveBound : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    core::Result<Listening> listening = listen_at({std::string(GetParam()) + ":0"});
    if (!listening && GetParam()[0] == '[') GTEST_SKIP() << "no IPv6 here";
    ASSERT_TRUE(listening) << listening.error().message;
    ASSERT_TRUE(keep_beginnings(listening->sockets[0]));
    sockaddr_storage at{};
    socklen_t size = sizeof at;
    ASSERT_EQ(::getsockname(listening->sockets[0].get(), reinterpret_cast<sockaddr*>(&at), &size),
              0);
    near = core::Descriptor(::socket(at.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
    ASSERT_EQ(::connect(near.get(), reinterpret_cast<sockaddr*>(&at), size), 0);
    pollfd ready{listening->sockets[0].get(), POLLIN, 0};
    ASSERT_EQ(::poll(&ready, 1, 10'000), 1);
    far = core::Descriptor(::accept4(ready.fd, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    ASSERT_TRUE(far.valid());
    ::fcntl(near.get(), F_SETFL, O_NONBLOCK);
    beginning = take_beginning(far);
    ASSERT_TRUE(beginning);
  }

  /// What comes in until there are so many bytes, or nothing more for `quiet`.
  void receive(size_t most, std::chrono::milliseconds quiet) {
    std::string piece(4096, '\0');
    while (received.size() < most) {
      pollfd ready{far.get(), POLLIN, 0};
      if (::poll(&ready, 1, static_cast<int>(quiet.count())) <= 0) return;
      const ssize_t count = ::recv(far.get(), piece.data(), piece.size(), 0);
      if (count <= 0) return;
      received.append(piece, 0, static_cast<size_t>(count));
    }
  }

  core::Descriptor near;
  core::Descriptor far;
  std::optional<uint32_t> beginning;
  std::string received;
};

TEST_P(ReceiveBound, LetsInWhatItSaysUntilItIsRaisedAndLifted) {
  std::string text;
  for (int i = 0; text.size() < 30'000; ++i) text += std::to_string(i);
  bound_received(far, *beginning, 1000);
  ASSERT_EQ(::send(near.get(), text.data(), text.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(text.size()));
  receive(text.size(), 1s);
  EXPECT_EQ(received.size(), 1000U);
  EXPECT_EQ(bytes_received(far), 1000U);
  bound_received(far, *beginning, 2500);
  receive(2500, 20s);
  receive(text.size(), 100ms);
  EXPECT_EQ(received.size(), 2500U);
  lift_bound(far);
  receive(text.size(), 20s);
  EXPECT_EQ(received, text);
}

INSTANTIATE_TEST_SUITE_P(Families, ReceiveBound, testing::Values("127.0.0.1", "[::1]", "[::]"));

}  // namespace
}  // namespace hyades::coordinator
