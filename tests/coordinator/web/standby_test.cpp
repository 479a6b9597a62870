// What answers for a coordinator that stands by.
#include "coordinator/web/standby_server.h"

#include <gtest/gtest.h>

#include <atomic>

#include "farm/certificate_maker.h"
#include "farm/json_form.h"
#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

/// One of its own, and what it says of the leader.
struct Standby {
  explicit Standby(const std::string& leader) {
    farm::Listen listen;
    listen.address = "127.0.0.1:0";
    auto started = StandbyServer::start(listen, [leader] { return leader; });
    EXPECT_TRUE(started.ok());
    server = std::move(*started);
    client = std::make_unique<HttpClient>(server->url());
  }

  std::unique_ptr<StandbyServer> server;
  std::unique_ptr<HttpClient> client;
};

TEST(StandbyServer, TellsThatItIsWellAndDoesNotLead) {
  const Standby standby("http://leader.example:8080");
  const auto health = standby.client->get("/healthz");
  EXPECT_EQ(health.status, 200);
  EXPECT_EQ(health.body, "well\n");
  const auto ready = standby.client->get("/readyz?verbose");
  EXPECT_EQ(ready.status, 200);
  EXPECT_EQ(ready.body, "stands by\n");
  const auto metrics = standby.client->get("/metrics");
  EXPECT_EQ(metrics.status, 200);
  EXPECT_EQ(metrics.headers.at("content-type"), "text/plain; version=0.0.4; charset=utf-8");
  EXPECT_NE(metrics.body.find("\nhyades_coordinator_leads 0\n"), std::string::npos) << metrics.body;
}

TEST(StandbyServer, TheOneThatLeadsTellsSo) {
  WebWorld world;
  world.start();
  EXPECT_NE(world.client->get("/metrics").body.find("\nhyades_coordinator_leads 1\n"),
            std::string::npos);
}

TEST(StandbyServer, SendsAllElseToTheOneThatLeads) {
  const Standby standby("http://leader.example:8080");
  for (const char* target : {"/", "/api/v1/jobs?limit=3&owner=%61da", "/healthz/more", "//x"}) {
    const auto there = standby.client->get(target);
    EXPECT_EQ(there.status, 307) << target;
    EXPECT_EQ(there.headers.at("location"), std::string("http://leader.example:8080") + target);
    EXPECT_EQ(there.headers.at("content-length"), "0");
    EXPECT_EQ(there.headers.at("cache-control"), "no-store");
  }
  const std::string body(300'000, 'x');
  for (const char* method : {"POST", "PUT", "DELETE"}) {
    const auto there = standby.client->send(method, "/api/v1/jobs", body);
    EXPECT_EQ(there.status, 307) << method;
    EXPECT_EQ(there.headers.at("location"), "http://leader.example:8080/api/v1/jobs");
  }
  EXPECT_EQ(standby.client->post("/healthz").status, 307) << "it answers GET alone";
  EXPECT_EQ(standby.client->get("no-target").status, 400);
}

TEST(StandbyServer, WhereNoneLeadsItSaysWhenToComeAgain) {
  const Standby standby("");
  for (const char* method : {"GET", "POST"}) {
    const auto later = standby.client->send(method, "/api/v1/jobs");
    EXPECT_EQ(later.status, 503);
    EXPECT_EQ(later.headers.at("retry-after"), "1");
    EXPECT_EQ(farm::Json::parse(later.body)["error"]["message"],
              "this coordinator stands by, and none leads at the moment: try again soon");
  }
  EXPECT_EQ(standby.client->get("/readyz").status, 200);
}

TEST(StandbyServer, AsksEachTimeWhoLeads) {
  std::atomic<bool> second{false};
  farm::Listen listen;
  listen.address = "127.0.0.1:0";
  const auto server =
      StandbyServer::start(listen, [&] { return second ? "https://b:1" : "http://a:1"; });
  ASSERT_TRUE(server.ok());
  const HttpClient client((*server)->url());
  EXPECT_EQ(client.get("/x").headers.at("location"), "http://a:1/x");
  second = true;
  EXPECT_EQ(client.get("/x").headers.at("location"), "https://b:1/x");
}

TEST(StandbyServer, LeavesItsAddressToTheServerThatComesAfter) {
  WebWorld world;
  world.farm.start();
  std::string address;
  {
    const Standby standby("http://leader.example:8080");
    address = standby.server->url().substr(standby.server->url().find("//") + 2);
    EXPECT_EQ(standby.client->get("/healthz").status, 200);
  }
  farm::Listen listen;
  listen.address = address;
  const auto web = WebServer::start(listen, *world.farm.controller, *world.farm.authority);
  ASSERT_TRUE(web.ok()) << web.error().message;
  EXPECT_EQ(HttpClient((*web)->url()).get("/readyz").body, "ready\n");
}

TEST(StandbyServer, HasTheSameRulesForItsDoor) {
  const auto leader = [] { return std::string(); };
  farm::Listen listen;
  listen.address = "0.0.0.0:0";
  EXPECT_FALSE(StandbyServer::start(listen, leader).ok()) << "plain text beyond this machine";
  const test::TempFolder folder;
  ASSERT_TRUE(farm::make_authority(folder.path().string(), "farm", 10).ok());
  farm::CertificateRequest request;
  request.name = "standby";
  request.ips = {"127.0.0.1"};
  request.server = true;
  ASSERT_TRUE(farm::issue_certificate(folder.path().string(), request).ok());
  listen.address = "127.0.0.1:0";
  listen.cert_file = folder.file("standby.pem");
  listen.key_file = folder.file("standby.key");
  const auto secure = StandbyServer::start(listen, leader);
  ASSERT_TRUE(secure.ok()) << secure.error().message;
  EXPECT_EQ((*secure)->url().find("https://"), 0U);
  EXPECT_EQ(HttpClient((*secure)->url()).get("/healthz").status, 0) << "plain text";
}

}  // namespace
}  // namespace hyades::coordinator
