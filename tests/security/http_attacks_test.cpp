// What strangers try over HTTP: bytes that two programs on the way read as different requests,
// hosts that are not ours, cookies that another host could plant.
#include <gtest/gtest.h>

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
