// Strangers who come in crowds, and take their time.
#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "coordinator/web/connection_count.h"
#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

std::string token_of(WebWorld& world, const std::string& name, v1::Role role) {
  std::string token;
  StoredToken row;
  EXPECT_TRUE(world.farm.authority->create(name, role, 0, token, row).ok());
  return token;
}

/// A listener for health alone beside that of the world.
auto serve_health(WebWorld& world) {
  farm::Listen listen = world.farm.how;
  listen.address = "127.0.0.1:0";
  auto health =
      WebServer::start(listen, *world.farm.controller, *world.farm.authority, {}, Serves::health);
  EXPECT_TRUE(health);
  return health;
}

TEST(Crowds, AFewAddressesDoNotTakeAllConnections) {
  for (const int attackers : {1, 4, 20, 100}) {
    ConnectionCount count(4000, 1000, 8);
    const auto address = [](int number) { return Neighbour{"attacker " + std::to_string(number)}; };
    for (bool any = true; any;) {
      any = false;
      for (int i = 0; i < attackers; ++i) {
        if (!count.may_come(address(i))) continue;
        count.enter(address(i));
        any = true;
      }
    }
    const Neighbour honest{"198.51.100.7"};
    int came = 0;
    for (; came < 10 && count.may_come(honest); ++came) count.enter(honest);
    EXPECT_EQ(came, 10) << attackers << " attackers";
  }
}

/// Connections that begin a request and never end it, or read nothing of the answer.
class SlowRequests {
 public:
  SlowRequests(const std::string& url, int count, const std::string& begin) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<uint16_t>(std::stoi(url.substr(url.rfind(':') + 1))));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (int i = 0; i < count; ++i) {
      const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
      const int small = 4096;  // what the kernel takes in of an answer
      ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
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

// A body takes its room from when it is announced.
TEST(Crowds, BodiesThatNeverComeLeaveRoomForOthers) {
  WebWorld world;
  world.start();
  const auto announce = [](const std::string& token) {
    return "POST /api/v1/jobs HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer " + token +
           "\r\nContent-Type: application/json\r\nContent-Length: 16777216\r\n\r\n";
  };
  const std::string root = token_of(world, "root", v1::ROLE_ADMIN);
  const std::string ada = token_of(world, "ada", v1::ROLE_SUBMITTER);
  const std::string bob = token_of(world, "bob", v1::ROLE_SUBMITTER);
  const auto large = [&](const std::string& token) {
    const std::string text(size_t{1} << 20U, 'a');
    return world.client
        ->send("PUT",
               "/api/v1/assets/" + core::to_hex(core::sha256(text)) +
                   "?size=" + std::to_string(text.size()),
               text, {{"Authorization", "Bearer " + token}})
        .status;
  };
  const auto expect_small_ones_come_in = [&] {
    EXPECT_EQ(world.client->post("/api/v1/session", farm::Json({{"token", bob}}).dump()).status,
              204);
    EXPECT_EQ(
        world.client->post("/api/v1/jobs/4711/cancel", "{}", {{"Authorization", "Bearer " + root}})
            .status,
        404);
  };

  const SlowRequests of_ada(world.web->url(), 16, announce(ada));
  EXPECT_TRUE(eventually([&] { return large(ada) == 503; })) << "she has a quarter";
  EXPECT_EQ(large(bob), 200);
  expect_small_ones_come_in();
  std::vector<std::unique_ptr<SlowRequests>> of_more;
  for (const char* name : {"carl", "dora", "eve"}) {
    of_more.push_back(std::make_unique<SlowRequests>(
        world.web->url(), 16, announce(token_of(world, name, v1::ROLE_SUBMITTER))));
  }
  EXPECT_TRUE(eventually([&] { return large(bob) == 503; })) << "four of them have all";
  expect_small_ones_come_in();
}

// Each answer is 15 MB, and a quarter of 256 MiB is one caller's.
TEST(UnreadAnswers, LeaveRoomForThoseOfOthers) {
  WebWorld world;
  world.start();
  std::string text = FarmWorld::document(1);
  while (text.size() < 15'000'000) text += "# " + std::string(1000, 'x') + "\n";
  ASSERT_TRUE(world.farm.upload(text).ok());
  v1::SubmitResponse job;
  ASSERT_TRUE(
      world.farm.jobs->Submit(world.farm.context().get(), FarmWorld::request(text), &job).ok());
  const std::string ada = token_of(world, "ada", v1::ROLE_ADMIN);
  const std::string bob = token_of(world, "bob", v1::ROLE_ADMIN);
  const std::string path = "/api/v1/jobs/" + std::to_string(job.job().id()) + "/document";
  const auto status_for = [&](const std::string& token) {
    return world.client->get(path, {{"Authorization", "Bearer " + token}}).status;
  };
  ASSERT_EQ(status_for(ada), 200);
  const std::string request =
      "GET " + path + " HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer " + ada + "\r\n\r\n";
  std::vector<std::unique_ptr<SlowRequests>> unread;
  EXPECT_TRUE(eventually([&] {
    unread.push_back(std::make_unique<SlowRequests>(world.web->url(), 1, request));
    return status_for(ada) == 503;
  }));
  EXPECT_EQ(status_for(bob), 200);
}

TEST(Crowds, HealthHasAPlaceThatTheyDoNotReach) {
  WebWorld world;
  world.start();
  const auto health = serve_health(world);
  ASSERT_TRUE(health);
  // This machine's own may take all connections: nobody else comes in until they end.
  const SlowRequests crowd(world.web->url(), 4100, "GET /");
  const HttpClient client((*health)->url());
  for (const char* path : {"/healthz", "/readyz", "/metrics"}) {
    EXPECT_EQ(client.get(path).status, 200) << path;
  }
  EXPECT_EQ(client.get("/api/v1/jobs").status, 404) << "nothing else is there";
}

// Each had as many turns as it had sent requests, and of those outside one came in with each turn.
TEST(Crowds, WhoAsksForMuchAtOnceKeepsNobodyWaiting) {
  WebWorld world;
  world.start();
  (void)token_of(world, "root", v1::ROLE_ADMIN);  // from now on those without one are strangers
  const auto health = serve_health(world);
  ASSERT_TRUE(health);
  std::string many;
  for (int i = 0; i < 400; ++i) many += "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";
  for (const std::string& url : {(*health)->url(), world.web->url()}) {
    const SlowRequests crowd(url, 3000, many);
    const auto asked = std::chrono::steady_clock::now();
    EXPECT_EQ(HttpClient(url).get("/healthz").status, 200);
    EXPECT_LT(std::chrono::steady_clock::now() - asked, 3s) << url;
  }
}

TEST(Crowds, StrangersAskForLittleAtOnce) {
  WebWorld world;
  world.start();
  const std::string secret = token_of(world, "root", v1::ROLE_ADMIN);
  const auto health = serve_health(world);
  ASSERT_TRUE(health);
  const auto answers = [](const std::string& url, const std::string& headers) {
    std::string asked;
    for (int i = 0; i < 40; ++i) asked += "GET /healthz HTTP/1.1\r\nHost: localhost\r\n" + headers;
    const std::string all = HttpClient(url).exchange(
        asked + "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + headers);
    int count = 0;
    for (size_t at = 0; (at = all.find("HTTP/1.1 200", at)) != std::string::npos; ++at) ++count;
    return count;
  };
  const std::string token = "Authorization: Bearer " + secret + "\r\n\r\n";
  EXPECT_LE(answers((*health)->url(), token), 1);
  EXPECT_LE(answers(world.web->url(), "\r\n"), 9);
  EXPECT_EQ(answers(world.web->url(), token), 41) << "who has shown a token may";
  const std::string said =
      HttpClient((*health)->url()).exchange("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(said.substr(0, 12), "HTTP/1.1 200");
  EXPECT_NE(said.find("Connection: close"), std::string::npos) << "the next comes anew";
}

}  // namespace
}  // namespace hyades::coordinator
