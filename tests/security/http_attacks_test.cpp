// What strangers try over HTTP: bytes that two programs on the way read as different requests,
// hosts that are not ours, cookies that another host could plant.
#include <gtest/gtest.h>

#include <string>

#include <fmt/format.h>

#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

class HttpAttacks : public ::testing::Test {
 protected:
  void SetUp() override { world_.start(); }
  /// The status line of the one answer that comes for these bytes.
  std::string answer_to(const std::string& bytes) const {
    const std::string all = world_.client->exchange(bytes);
    EXPECT_EQ(all.find("HTTP/1.1", 1), std::string::npos) << "a second answer: " << all;
    return all.substr(all.find(' ') + 1, all.find('\r') - all.find(' ') - 1);
  }
  WebWorld world_;
};

const std::string kHidden = "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";

TEST_F(HttpAttacks, ABodyIsNeverASecondRequest) {
  for (const char* encoding :
       {"gzip", "chunked, gzip", "gzip, chunked", "identity", "xchunked", "chunked, chunked",
        "\x0b"
        "chunked",
        ""}) {
    const std::string said =
        answer_to(std::string("POST /api/v1/assets/missing HTTP/1.1\r\nHost: localhost\r\n") +
                  "Transfer-Encoding: " + encoding + "\r\n\r\n" + kHidden);
    EXPECT_EQ(said, "400 Bad Request") << "Transfer-Encoding: " << encoding;
  }
  const std::string post = "POST /api/v1/assets/missing HTTP/1.1\r\nHost: localhost\r\n";
  EXPECT_EQ(
      answer_to(post + "Transfer-Encoding: chunked\r\nTransfer-Encoding: gzip\r\n\r\n0\r\n\r\n" +
                kHidden),
      "400 Bad Request");
  EXPECT_EQ(answer_to(post + "Content-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n" +
                      kHidden),
            "400 Bad Request");
  EXPECT_EQ(answer_to(post + "Content-Length: 4\r\nContent-Length: 5\r\n\r\n{}  " + kHidden),
            "400 Bad Request");
  EXPECT_EQ(
      answer_to(
          "POST /api/v1/assets/missing HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n" +
          kHidden),
      "400 Bad Request");
}

TEST_F(HttpAttacks, ARequestNamesOneHost) {
  EXPECT_EQ(answer_to("GET /healthz HTTP/1.1\r\nConnection: close\r\n\r\n"), "400 Bad Request");
  EXPECT_EQ(answer_to("GET /healthz HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n"),
            "400 Bad Request");
  EXPECT_EQ(answer_to("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"),
            "200 OK");
}

const std::string kChunked = "Host: localhost\r\nTransfer-Encoding: chunked\r\n\r\n";

// Once all of it was kept in memory, however much came.
TEST_F(HttpAttacks, WhatIsBesideAChunksBytesIsNotLong) {
  constexpr size_t kLong = size_t{8} << 20U;
  std::string fields;
  while (fields.size() < kLong) fields += "x: y\r\n";
  const std::string first = "1\r\n{\r\n";
  const std::string attacks[] = {std::string(kLong, '0'), "1;a=" + std::string(kLong, 'a'),
                                 first + "0;a=" + std::string(kLong, 'a'), first + "0\r\n" + fields,
                                 first + "0\r\nx: " + std::string(kLong, 'y')};
  for (const std::string& attack : attacks) {
    EXPECT_EQ(answer_to("POST /api/v1/session HTTP/1.1\r\n" + kChunked + attack),
              "413 Payload Too Large")
        << attack.substr(0, 20);
  }
}

TEST_F(HttpAttacks, WhereNoBodyBelongsNoneIsAwaited) {
  farm::Listen listen = world_.farm.how;
  listen.address = "127.0.0.1:0";
  auto health =
      WebServer::start(listen, *world_.farm.controller, *world_.farm.authority, {}, Serves::health);
  ASSERT_TRUE(health);
  for (const std::string& url : {world_.web->url(), (*health)->url()}) {
    const std::string said = HttpClient(url).exchange("GET /healthz HTTP/1.1\r\n" + kChunked);
    EXPECT_EQ(said.substr(0, 12), "HTTP/1.1 413") << said;
  }
}

// What is bounded is what has not been looked at yet, not what may come.
TEST_F(HttpAttacks, MuchThatIsInOrderComesIn) {
  const std::string text(size_t{8} << 20U, 'a');
  const std::string file =
      "/api/v1/assets/" + core::to_hex(core::sha256(text)) + "?size=" + std::to_string(text.size());
  EXPECT_EQ(world_.client->send("PUT", file, text).status, 200);
  for (const size_t size : {text.size(), size_t{1000}}) {
    std::string body;
    for (size_t at = 0; at < text.size(); at += size) {
      const std::string chunk = text.substr(at, size);
      body += fmt::format("{:x};part=yes\r\n{}\r\n", chunk.size(), chunk);
    }
    EXPECT_EQ(answer_to("PUT " + file + " HTTP/1.1\r\nConnection: close\r\n" + kChunked + body +
                        "0\r\nsum: 7\r\n\r\n"),
              "200 OK")
        << "in chunks of " << size;
  }
  // One behind the other, without waiting for the answers.
  std::string requests;
  constexpr int kRequests = 5000;
  for (int i = 1; i < kRequests; ++i) {
    requests += "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";
  }
  const std::string all = world_.client->exchange(requests + kHidden);
  int answers = 0;
  for (size_t at = 0; (at = all.find("HTTP/1.1 200", at)) != std::string::npos; ++at) ++answers;
  EXPECT_EQ(answers, kRequests);
}

TEST(Cookies, BehindAProxyThatSpeaksTlsTheyAreItsAlone) {
  WebWorld world;
  world.farm.token = std::string(40, 't');
  world.start();
  std::string text;
  StoredToken row;
  ASSERT_TRUE(world.farm.authority->create("root", v1::ROLE_ADMIN, 0, text, row).ok());
  const std::string body = farm::Json({{"token", text}}).dump();
  const auto plain = world.client->post("/api/v1/session", body);
  ASSERT_EQ(plain.status, 204) << plain.body;
  EXPECT_EQ(plain.headers.at("set-cookie").find("hyades_session_"), 0U);
  EXPECT_EQ(plain.headers.at("set-cookie").find("Secure"), std::string::npos);
  const HttpClient::Headers proxy = {{"X-Forwarded-Proto", "https"}};
  const auto behind = world.client->post("/api/v1/session", body, proxy);
  const std::string set = behind.headers.at("set-cookie");
  EXPECT_EQ(set.find("__Host-hyades_session_"), 0U) << set;
  EXPECT_NE(set.find("; Secure"), std::string::npos) << set;
  const std::string cookie = set.substr(0, set.find(';'));
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Cookie", cookie}, proxy[0]}).status, 200);
  // One without the prefix, as another host of the domain could have set it, is none there.
  const std::string planted = cookie.substr(std::string("__Host-").size());
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Cookie", planted}, proxy[0]}).status, 401);
}

}  // namespace
}  // namespace hyades::coordinator
