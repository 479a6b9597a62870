// Strangers who come in crowds, and take their time.
#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <vector>

#include "coordinator/web/connection_count.h"
#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

TEST(Crowds, AFewAddressesDoNotTakeAllConnections) {
  for (const int attackers : {1, 4, 20, 100}) {
    ConnectionCount count(4000, 1000, 8);
    const auto address = [](int number) {
      return boost::asio::ip::make_address("192.0." + std::to_string(number / 200) + "." +
                                           std::to_string(number % 200 + 1));
    };
    for (bool any = true; any;) {
      any = false;
      for (int i = 0; i < attackers; ++i) {
        if (!count.may_come(address(i))) continue;
        count.enter(address(i));
        any = true;
      }
    }
    const auto honest = boost::asio::ip::make_address("198.51.100.7");
    int came = 0;
    for (; came < 10 && count.may_come(honest); ++came) count.enter(honest);
    EXPECT_EQ(came, 10) << attackers << " attackers";
  }
}

/// Connections that begin a request and never end it.
class SlowRequests {
 public:
  SlowRequests(const std::string& url, int count, const std::string& begin) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<uint16_t>(std::stoi(url.substr(url.rfind(':') + 1))));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (int i = 0; i < count; ++i) {
      const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
      if (::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) {
        (void)!::send(socket, begin.data(), begin.size(), MSG_NOSIGNAL);
      }
      sockets_.push_back(socket);
    }
  }
  ~SlowRequests() {
    for (const int socket : sockets_) ::close(socket);
  }
  SlowRequests(const SlowRequests&) = delete;
  SlowRequests& operator=(const SlowRequests&) = delete;
  /// Whether the other side has ended all of them within this time.
  bool ended(std::chrono::seconds within) const {
    const auto until = std::chrono::steady_clock::now() + within;
    for (const int socket : sockets_) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          until - std::chrono::steady_clock::now());
      timeval patience{std::max<long>(left.count() / 1000, 0), 100'000};
      ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
      char byte = 0;
      ssize_t got = 0;
      while ((got = ::recv(socket, &byte, 1, 0)) > 0) {
      }
      if (got < 0 && errno != ECONNRESET) return false;
    }
    return true;
  }

 private:
  std::vector<int> sockets_;
};

TEST(Crowds, RequestsThatAreNotEndedAreEnded) {
  WebWorld world;
  world.start();
  const SlowRequests headers(world.web->url(), 50, "GET /healthz HTTP/1.1\r\nHost: local");
  const SlowRequests silent(world.web->url(), 50, "");
  EXPECT_TRUE(headers.ended(20s));
  EXPECT_TRUE(silent.ended(20s));
}

TEST(Crowds, HealthHasAPlaceThatTheyDoNotReach) {
  WebWorld world;
  world.start();
  farm::Listen listen = world.farm.how;
  listen.address = "127.0.0.1:0";
  auto health =
      WebServer::start(listen, *world.farm.controller, *world.farm.authority, {}, Serves::health);
  ASSERT_TRUE(health);
  // This machine's own may take all connections: nobody else comes in until they end.
  const SlowRequests crowd(world.web->url(), 4100, "GET /");
  const HttpClient client((*health)->url());
  for (const char* path : {"/healthz", "/readyz", "/metrics"}) {
    EXPECT_EQ(client.get(path).status, 200) << path;
  }
  EXPECT_EQ(client.get("/api/v1/jobs").status, 404) << "nothing else is there";
}

}  // namespace
}  // namespace hyades::coordinator
