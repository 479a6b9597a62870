// HTTP itself: connections that stay, requests that come at once, bodies that wait, TLS, packing.
#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include "coordinator/web/gzip.h"
#include "core/base/gunzip.h"
#include "farm/certificate_maker.h"
#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

size_t count_of(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

const std::string kHead = " HTTP/1.1\r\nHost: localhost\r\n";

TEST(Protocol, AConnectionIsUsedAgain) {
  WebWorld world;
  world.start();
  // Both are there before the first is answered; the answers come in order.
  const std::string both = world.client->exchange("GET /healthz" + kHead + "\r\nGET /api/v1/info" +
                                                  kHead + "Connection: close\r\n\r\n");
  EXPECT_EQ(count_of(both, "HTTP/1.1 200"), 2U) << both;
  EXPECT_LT(both.find("well\n"), both.find("\"protocol\""));
  EXPECT_EQ(count_of(both, "Connection: close"), 1U);
}

TEST(Protocol, ManyRequestsAtOnceAreAnsweredInOrder) {
  WebWorld world;
  world.start();
  std::string asked;
  for (int i = 0; i < 40; ++i) {
    // Some are answered by the network's thread, some by pool.
    asked += (i % 2 == 0 ? "GET /healthz" : "GET /api/v1/jobs") + kHead + "\r\n";
  }
  const std::string all =
      world.client->exchange(asked + "GET /healthz" + kHead + "Connection: close\r\n\r\n");
  EXPECT_EQ(count_of(all, "HTTP/1.1 200"), 41U);
  EXPECT_EQ(count_of(all, "well\n"), 21U);
  EXPECT_EQ(count_of(all, "\"next_before\""), 20U);
}

TEST(Protocol, ABodyThatWaitsForLeaveGetsIt) {
  WebWorld world;
  world.start();
  const std::string body = R"({"files": []})";
  // A client that sends the body without waiting may do so.
  const std::string answer = world.client->exchange(
      "POST /api/v1/assets/missing" + kHead + "Connection: close\r\nExpect: 100-continue\r\n" +
      "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  EXPECT_EQ(answer.find("HTTP/1.1 100 Continue\r\n\r\n"), 0U) << answer;
  EXPECT_EQ(count_of(answer, "HTTP/1.1 200"), 1U) << answer;
}

TEST(Protocol, ABodyThatMayNotComeGetsNoLeave) {
  WebWorld world;
  world.start();
  const std::string answer = world.client->exchange(
      "POST /api/v1/jobs/1/cancel" + kHead +
      "Connection: close\r\nExpect: 100-continue\r\nContent-Length: 9000000\r\n\r\n");
  EXPECT_EQ(answer.find("HTTP/1.1 413"), 0U) << answer;
}

TEST(Protocol, ChunkedBodiesAreTaken) {
  WebWorld world;
  world.start();
  const std::string answer =
      world.client->exchange("POST /api/v1/assets/missing" + kHead +
                             "Connection: close\r\nTransfer-Encoding: chunked\r\n\r\n"
                             "6\r\n{\"file\r\n7\r\ns\": []}\r\n0\r\n\r\n");
  EXPECT_EQ(answer.find("HTTP/1.1 200"), 0U) << answer;
}

TEST(Protocol, TheDashboardComesPackedToWhoTakesThat) {
  WebWorld world;
  world.start();
  const auto plain = world.client->get("/dashboard/style.css");
  ASSERT_EQ(plain.status, 200);
  EXPECT_FALSE(plain.headers.contains("content-encoding"));
  const auto packed = world.client->get("/dashboard/style.css", {{"Accept-Encoding", "br, gzip"}});
  ASSERT_EQ(packed.status, 200);
  EXPECT_EQ(packed.headers.at("content-encoding"), "gzip");
  EXPECT_EQ(packed.headers.at("vary"), "Accept-Encoding");
  EXPECT_LT(2 * packed.body.size(), plain.body.size());
  EXPECT_NE(packed.headers.at("etag"), plain.headers.at("etag"));
  const auto unpacked = core::gunzip(std::as_bytes(std::span(packed.body)), plain.body.size());
  ASSERT_TRUE(unpacked.ok()) << (unpacked ? "" : unpacked.error().message);
  EXPECT_EQ(std::string(unpacked->chars(), unpacked->size()), plain.body);
  EXPECT_EQ(world.client
                ->get("/dashboard/style.css",
                      {{"Accept-Encoding", "gzip"}, {"If-None-Match", packed.headers.at("etag")}})
                .status,
            304);
}

TEST(Protocol, ABrowserThatAsksForNoPageIsBroughtToTheOneThatSaysSo) {
  WebWorld world;
  world.start();
  const HttpClient::Headers browser{{"Accept", "text/html,*/*;q=0.8"}};
  for (const char* path : {"/jobs/1", "/job/1", "/nope"}) {
    const auto there = world.client->get(path, browser);
    EXPECT_EQ(there.status, 302) << path;
    EXPECT_EQ(there.headers.at("location"), std::string("/#") + path);
    EXPECT_EQ(there.headers.at("content-length"), "0") << "or readers wait for an end";
    EXPECT_EQ(world.client->get(path).status, 404) << "programs are told so";
  }
  EXPECT_EQ(world.client->get("/api/v1/nope", browser).status, 404);
  EXPECT_EQ(world.client->get("/dashboard/nope", browser).status, 404);
}

TEST(Protocol, WhoTakesPackedBytesIsUnderstood) {
  EXPECT_TRUE(takes_gzip("gzip"));
  EXPECT_TRUE(takes_gzip("deflate, gzip;q=0.5"));
  EXPECT_TRUE(takes_gzip("*"));
  EXPECT_FALSE(takes_gzip(""));
  EXPECT_FALSE(takes_gzip("identity, br"));
  EXPECT_FALSE(takes_gzip("gzip;q=0, *"));
  EXPECT_FALSE(takes_gzip("gzip;q=0.000"));
}

/// What a server says over TLS, until it ends.
std::string exchange_over_tls(const std::string& url, const std::string& bytes,
                              const std::string& trusted) {
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_client_method()),
                                                                  &SSL_CTX_free);
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
  EXPECT_EQ(SSL_CTX_load_verify_locations(context.get(), trusted.c_str(), nullptr), 1);
  const std::unique_ptr<BIO, decltype(&BIO_free_all)> bio(BIO_new_ssl_connect(context.get()),
                                                          &BIO_free_all);
  BIO_set_conn_hostname(bio.get(), url.substr(url.find("://") + 3).c_str());
  if (BIO_do_connect(bio.get()) != 1) return "no connection";
  BIO_write(bio.get(), bytes.data(), static_cast<int>(bytes.size()));
  std::string all;
  char piece[65536];
  for (;;) {
    const int count = BIO_read(bio.get(), piece, sizeof piece);
    if (count <= 0) return all;
    all.append(piece, static_cast<size_t>(count));
  }
}

class OverTls : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string folder = world.farm.folder.file("certs");
    ASSERT_TRUE(farm::make_authority(folder, "farm", 10).ok());
    farm::CertificateRequest server;
    server.name = "coordinator";
    server.ips = {"127.0.0.1"};
    server.server = true;
    ASSERT_TRUE(farm::issue_certificate(folder, server).ok());
    authority = folder + "/ca.pem";
    world.farm.how.cert_file = folder + "/coordinator.pem";
    world.farm.how.key_file = folder + "/coordinator.key";
    world.start();
  }
  WebWorld world;
  std::string authority;
};

TEST_F(OverTls, TheSameIsAnswered) {
  ASSERT_EQ(world.web->url().find("https://"), 0U);
  const std::string both =
      exchange_over_tls(world.web->url(),
                        "GET /api/v1/info" + kHead + "\r\nGET /dashboard/style.css" + kHead +
                            "Connection: close\r\n\r\n",
                        authority);
  EXPECT_EQ(count_of(both, "HTTP/1.1 200"), 2U) << both.substr(0, 300);
  EXPECT_NE(both.find("\"protocol\""), std::string::npos);
}

TEST_F(OverTls, PlainTextIsNotUnderstood) {
  EXPECT_EQ(world.client->get("/healthz").status, 0);
  EXPECT_EQ(exchange_over_tls(world.web->url(),
                              "GET /healthz" + kHead + "Connection: close\r\n\r\n", authority)
                .find("HTTP/1.1 200"),
            0U)
      << "whoever came before with something else";
}

}  // namespace
}  // namespace hyades::coordinator
