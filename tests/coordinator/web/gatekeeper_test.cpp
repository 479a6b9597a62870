// Who may come in, and what is no request at all.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

using farm::Json;

constexpr const char* kToken = "a-token-of-enough-letters";

class Guarded : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string file = world.farm.folder.file("token");
    std::ofstream(file) << kToken << "\n";
    world.farm.how.token_file = file;
    world.farm.token = kToken;
    world.start();
  }
  WebWorld world;
};

TEST_F(Guarded, NothingIsToldWithoutTheToken) {
  for (const std::string target : {"/api/v1/info", "/api/v1/jobs", "/api/v1/events", "/metrics",
                                   "/api/v1/jobs/1/outputs/a.png", "/api/v1/workers"}) {
    const auto response = world.client->get(target);
    EXPECT_EQ(response.status, 401) << target;
    EXPECT_EQ(Json::parse(response.body)["error"]["code"], "unauthenticated");
  }
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Authorization", "Bearer wrong"}}).status, 401);
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Authorization", std::string("Bearer ") + kToken}})
                .status,
            200);
  // What a load balancer and a person who wants to sign in need.
  EXPECT_EQ(world.client->get("/healthz").status, 200);
  EXPECT_EQ(world.client->get("/readyz").status, 200);
  EXPECT_EQ(world.client->get("/").status, 200);
}

TEST_F(Guarded, ASessionOpensWhatTheTokenOpens) {
  const auto signed_in = world.client->post("/api/v1/session", Json({{"token", kToken}}).dump());
  ASSERT_EQ(signed_in.status, 204);
  const std::string set = signed_in.headers.at("set-cookie");
  EXPECT_NE(set.find("HttpOnly"), std::string::npos);
  EXPECT_NE(set.find("SameSite=Strict"), std::string::npos);
  EXPECT_EQ(set.find(kToken), std::string::npos) << "the token itself does not travel in it";
  const std::string cookie = set.substr(0, set.find(';'));
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Cookie", "a=b; " + cookie}}).status, 200);
  std::string forged = cookie;
  forged[std::string("hyades_session=").size()] = '9';  // a later end
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Cookie", forged}}).status, 401);
  EXPECT_EQ(world.client->post("/api/v1/session", R"({"token": "wrong"})").status, 401);
  EXPECT_EQ(world.client->post("/api/v1/session", "[").status, 401);
}

TEST(Gatekeeper, PagesOfOtherSitesMayNotSteer) {
  WebWorld world;
  world.start();
  const uint64_t job = world.farm.submit(1);
  const std::string cancel = "/api/v1/jobs/" + std::to_string(job) + "/cancel";
  EXPECT_EQ(world.client->post(cancel, {}, {{"Origin", "https://evil.example"}}).status, 403);
  EXPECT_EQ(world.client->post(cancel, {}, {{"Origin", "null"}}).status, 403);
  EXPECT_EQ(world.client->post(cancel, {}, {{"Sec-Fetch-Site", "cross-site"}}).status, 403);
  EXPECT_EQ(world.client->get("/api/v1/jobs", {{"Sec-Fetch-Site", "cross-site"}}).status, 403);
  EXPECT_EQ(
      world.client->get("/", {{"Sec-Fetch-Site", "cross-site"}, {"Sec-Fetch-Mode", "navigate"}})
          .status,
      200)
      << "a link from elsewhere";
  EXPECT_EQ(world.client->post(cancel, {}, {{"Origin", world.web->url()}}).status, 200);
}

TEST(Gatekeeper, NamesThatAreNotThisMachinesAreRefusedWhereNothingElseGuards) {
  WebWorld world;
  world.start();
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Host", "evil.example:8080"}}).status, 403);
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Host", "localhost"}}).status, 200);
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Host", "localhost:99"}}).status, 200);
}

TEST(Gatekeeper, BeyondThisMachineOnlyWithTlsAndToken) {
  FarmWorld farm;
  farm.start();
  farm::Listen listen;
  listen.address = "0.0.0.0:0";
  EXPECT_FALSE(WebServer::start(listen, *farm.brain).ok());
}

TEST(WebServer, AnAddressThatIsTakenIsTold) {
  WebWorld world;
  world.start();
  farm::Listen listen;
  listen.address = world.web->url().substr(7);
  const auto second = WebServer::start(listen, *world.farm.brain);
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find(listen.address), std::string::npos);
}

TEST(WebServer, WhatIsNoRequestIsRefusedAndOthersAreServed) {
  WebWorld world;
  world.start();
  EXPECT_EQ(world.client->exchange("\x16\x03\x01\x02").find(" 200 "), std::string::npos);
  EXPECT_NE(world.client->exchange("nonsense\r\n\r\n").find(" 400 "), std::string::npos);
  EXPECT_NE(world.client->exchange("GET / HTTP/1.1\r\nX: " + std::string(20'000, 'a') + "\r\n\r\n")
                .find(" 431 "),
            std::string::npos);
  EXPECT_NE(
      world.client->exchange("PUT / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n").find(" 413 "),
      std::string::npos);
  EXPECT_EQ(world.client->get("/api/v1/../../etc/passwd").status, 400);
  EXPECT_EQ(world.client->get("/dashboard/%2e%2e/secret").status, 400);
  EXPECT_EQ(world.client->get("/api/v1/jobs/999").status, 404);
  EXPECT_EQ(world.client->get("/api/v1/jobs/seven").status, 404);
  EXPECT_EQ(world.client->get("/api/v1/jobs?limit=many").status, 400);
  EXPECT_EQ(world.client->send("PATCH", "/api/v1/jobs").status, 405);
  EXPECT_EQ(world.client->send("HEAD", "/").body, "");
  EXPECT_EQ(world.client->post("/api/v1/jobs", "{").status, 400);
  EXPECT_EQ(world.client->get("/api/v1/info").status, 200);
}

}  // namespace
}  // namespace hyades::coordinator
