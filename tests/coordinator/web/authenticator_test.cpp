// Who may come in, and what is no request at all.
#include <gtest/gtest.h>

#include <fstream>

#include "coordinator/access/listening.h"
#include "coordinator/operations/operation.h"
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
  forged.back() = forged.back() == '0' ? '1' : '0';
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Cookie", forged}}).status, 401);
  EXPECT_EQ(world.client->post("/api/v1/session", R"({"token": "wrong"})").status, 401);
  EXPECT_EQ(world.client->post("/api/v1/session", "[").status, 401);
}

/// With an admin's token, and others as tests want them.
class WithRoles : public ::testing::Test {
 protected:
  void SetUp() override {
    world.start();
    world.farm.token = make(v1::ROLE_ADMIN, "root");
  }
  std::string make(v1::Role role, const std::string& name) {
    std::string text;
    StoredToken row;
    const grpc::Status made = world.farm.authority->create(name, role, 0, text, row);
    EXPECT_TRUE(made.ok()) << made.error_message();
    id = row.id;
    return text;
  }
  static HttpClient::Headers with(const std::string& token) {
    return {{"Authorization", "Bearer " + token}};
  }
  WebWorld world;
  std::string id;  ///< of the last token
};

TEST_F(WithRoles, EachRoleIsRefusedWhatIsAboveIt) {
  const uint64_t job = world.farm.submit(1);
  const std::string one = "/api/v1/jobs/" + std::to_string(job);
  const std::pair<v1::Role, std::string> tokens[] = {
      {v1::ROLE_VIEWER, make(v1::ROLE_VIEWER, "vera")},
      {v1::ROLE_SUBMITTER, make(v1::ROLE_SUBMITTER, "sam")},
      {v1::ROLE_OPERATOR, make(v1::ROLE_OPERATOR, "olga")},
      {v1::ROLE_WORKER, make(v1::ROLE_WORKER, "node")}};
  for (const std::string& route : world.web->routes()) {
    const size_t space = route.find(' ');
    const Rule& rule = operation_of_route(route).rule;
    if (route.ends_with("events")) continue;  // they do not end
    std::string target = route.substr(space + 1);
    for (const auto& [name, value] : {std::pair("{job}", "999"),
                                      {"{frame}", "1"},
                                      {"{worker}", "9"},
                                      {"{sha256}", "00"},
                                      {"{path...}", "a"}}) {
      if (const size_t at = target.find(name); at != std::string::npos) {
        target.replace(at, std::string(name).size(), value);
      }
    }
    for (const auto& [role, token] : tokens) {
      const auto response = world.client->send(route.substr(0, space), target, {}, with(token));
      EXPECT_EQ(response.status == 403, !may(role, rule))
          << route << " " << farm::role_name(role) << " " << response.status << " "
          << response.body;
    }
    if (rule.least != v1::ROLE_UNSPECIFIED) {
      EXPECT_EQ(world.client->send(route.substr(0, space), target).status, 401) << route;
    }
  }
  EXPECT_EQ(world.client->post(one + "/cancel", {}, with(tokens[1].second)).status, 403)
      << "another's job";
  EXPECT_EQ(world.client->send("DELETE", one, {}, with(tokens[1].second)).status, 403);
  EXPECT_EQ(world.client->post(one + "/videos", {}, with(tokens[1].second)).status, 403);
  EXPECT_EQ(world.client->get(one + "/videos", with(tokens[0].second)).status, 200);
  EXPECT_EQ(world.client->post(one + "/videos", {}, with(tokens[2].second)).status, 409)
      << "it may, and no frame is finished";
  EXPECT_EQ(world.client->post(one + "/cancel", {}, with(tokens[2].second)).status, 200);
}

TEST_F(WithRoles, WhoIsSignedInIsToldAndHisSessionEndsWithHisToken) {
  const std::string text = make(v1::ROLE_SUBMITTER, "alice");
  const auto signed_in = world.client->post("/api/v1/session", Json({{"token", text}}).dump());
  ASSERT_EQ(signed_in.status, 204) << signed_in.body;
  const std::string set = signed_in.headers.at("set-cookie");
  EXPECT_EQ(set.find(text.substr(16)), std::string::npos);
  const std::string cookie = set.substr(0, set.find(';'));
  const auto me = world.client->get("/api/v1/session", {{"Cookie", cookie}});
  ASSERT_EQ(me.status, 200) << me.body;
  EXPECT_EQ(Json::parse(me.body), Json({{"guarded", true},
                                        {"role", "submitter"},
                                        {"name", "alice"},
                                        {"token_id", id},
                                        {"expires_ms", 0},
                                        {"expiring", ""}}));
  StoredToken row;
  ASSERT_TRUE(world.farm.authority->revoke(id, row).ok());
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Cookie", cookie}}).status, 401);
}

TEST_F(WithRoles, ASignInThatFailsIsKept) {
  const std::string text = make(v1::ROLE_VIEWER, "vera");
  StoredToken row;
  ASSERT_TRUE(world.farm.authority->revoke(id, row).ok());
  const auto sign_in = [&](const std::string& token) {
    return world.client->post("/api/v1/session", Json({{"token", token}}).dump()).status;
  };
  EXPECT_EQ(sign_in("wrong"), 401);
  EXPECT_EQ(sign_in(text), 401);
  EXPECT_EQ(sign_in(world.farm.token), 204);
  AuditLog& log = *world.farm.authority->audit();
  log.flush();
  auto reader = log.read();
  for (const std::string why : {"not a token", "was revoked"}) {
    const auto entry = reader.next();
    ASSERT_TRUE(entry) << why;
    EXPECT_EQ(entry->deed(), "session");
    EXPECT_EQ(entry->result(), "unauthenticated");
    EXPECT_NE(entry->detail().find(why), std::string::npos) << entry->detail();
    EXPECT_EQ(entry->address().rfind("127.0.0.1:", 0), 0U) << entry->address();
    EXPECT_EQ(entry->detail().find(text.substr(16)), std::string::npos) << "not the token itself";
  }
  EXPECT_FALSE(reader.next());
}

TEST_F(WithRoles, WhatIsDoneIsKeptAsItIsOverGrpc) {
  const uint64_t job = world.farm.submit(1);
  const std::string one = "/api/v1/jobs/" + std::to_string(job);
  const auto head = with(world.farm.token);
  EXPECT_EQ(world.client->send("PUT", one + "/priority", R"({"priority": 7})", head).status, 200);
  AuditLog& log = *world.farm.authority->audit();
  log.flush();
  auto reader = log.read();
  std::optional<v1::AuditEntry> last;
  for (auto entry = reader.next(); entry; entry = reader.next()) last = entry;
  ASSERT_TRUE(last);
  EXPECT_EQ(last->deed(), "job.priority");
  EXPECT_EQ(last->target(), std::to_string(job));
  EXPECT_EQ(last->detail(), "job: " + std::to_string(job) + " priority: 7");
}

TEST_F(WithRoles, WhoUploadsIsKeptOnceForAFile) {
  const auto head = with(make(v1::ROLE_SUBMITTER, "sam"));
  const std::string text(3000, 'x');
  const std::string target = "/api/v1/assets/" + core::to_hex(core::sha256(text)) + "?size=3000";
  for (int piece = 0; piece < 2; ++piece) {
    const std::string offset = "&offset=" + std::to_string(piece * 1000);
    EXPECT_EQ(world.client->send("PUT", target + offset, text.substr(0, 1000), head).status, 200);
  }
  AuditLog& log = *world.farm.authority->audit();
  log.flush();
  auto reader = log.read();
  const auto entry = reader.next();
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->deed(), "file.upload");
  EXPECT_EQ(entry->name(), "sam");
  EXPECT_EQ(entry->detail(), "3000 bytes");
  EXPECT_FALSE(reader.next());
}

TEST_F(WithRoles, SigningOutEndsTheSessionAndWhatIsOpenInIt) {
  const std::string text = make(v1::ROLE_VIEWER, "vera");
  const auto sign_in = [&] {
    const auto reply = world.client->post("/api/v1/session", Json({{"token", text}}).dump());
    const std::string set = reply.headers.at("set-cookie");
    return set.substr(0, set.find(';'));
  };
  const std::string cookie = sign_in();
  const std::string other = sign_in();
  HttpClient::Events events(*world.client, "/api/v1/events", {{"Cookie", cookie}});
  HttpClient::Events others(*world.client, "/api/v1/events", {{"Cookie", other}});
  ASSERT_EQ(events.next().name, "snapshot");
  ASSERT_EQ(others.next().name, "snapshot");
  const auto out = world.client->send("DELETE", "/api/v1/session", {}, {{"Cookie", cookie}});
  EXPECT_EQ(out.status, 204);
  EXPECT_NE(out.headers.at("set-cookie").find("Max-Age=0"), std::string::npos);
  for (auto event = events.next(); !event.name.empty(); event = events.next()) {
  }
  const auto after = world.client->get("/api/v1/info", {{"Cookie", cookie}});
  EXPECT_EQ(after.status, 401) << "whoever has kept the cookie";
  EXPECT_NE(after.body.find("the session is over"), std::string::npos);
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Cookie", other}}).status, 200);
  world.farm.submit(1);
  EXPECT_EQ(others.next().name, "change") << "in another browser they go on";
  EXPECT_EQ(world.client->send("DELETE", "/api/v1/session").status, 204) << "nothing to end";
}

TEST_F(WithRoles, SigningInWithoutEndEndsOnesOldestSessionAndWhatIsOpenInIt) {
  const auto sign_in = [&](const std::string& text) {
    const auto reply = world.client->post("/api/v1/session", Json({{"token", text}}).dump());
    const std::string set = reply.headers.at("set-cookie");
    return set.substr(0, set.find(';'));
  };
  const std::string others = sign_in(make(v1::ROLE_VIEWER, "olga"));
  const std::string text = make(v1::ROLE_VIEWER, "vera");
  const std::string first = sign_in(text);
  HttpClient::Events events(*world.client, "/api/v1/events", {{"Cookie", first}});
  ASSERT_EQ(events.next().name, "snapshot");
  for (int i = 0; i < 100; ++i) sign_in(text);
  for (auto event = events.next(); !event.name.empty(); event = events.next()) {
  }
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Cookie", first}}).status, 401);
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Cookie", others}}).status, 200);
}

TEST_F(WithRoles, ASessionDoesNotOutliveTheCoordinatorAndSaysSo) {
  const auto signed_in =
      world.client->post("/api/v1/session", Json({{"token", world.farm.token}}).dump());
  const std::string set = signed_in.headers.at("set-cookie");
  const std::string cookie = set.substr(0, set.find(';'));
  world.stop();
  world.start();
  const size_t name = std::string("hyades_session_").size();
  const std::string port = world.web->url().substr(world.web->url().rfind(':') + 1);
  const std::string again = cookie.substr(0, name) + port + cookie.substr(cookie.find('='));
  const auto answer = world.client->get("/api/v1/info", {{"Cookie", again}});
  EXPECT_EQ(answer.status, 401);
  EXPECT_NE(answer.body.find("sign in again"), std::string::npos) << answer.body;
}

TEST_F(WithRoles, CoordinatorsOfOneMachineDoNotTakeEachOthersCookies) {
  WebWorld second;
  second.start();
  std::string text;
  StoredToken row;
  ASSERT_TRUE(second.farm.authority->create("root", v1::ROLE_ADMIN, 0, text, row).ok());
  const auto cookie_of = [](const WebWorld& of, const std::string& token) {
    const auto reply = of.client->post("/api/v1/session", Json({{"token", token}}).dump());
    const std::string set = reply.headers.at("set-cookie");
    return set.substr(0, set.find(';'));
  };
  // A browser sends both to both.
  const std::string both = cookie_of(second, text) + "; " + cookie_of(world, world.farm.token);
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Cookie", both}}).status, 200);
  EXPECT_EQ(second.client->get("/api/v1/info", {{"Cookie", both}}).status, 200);
}

TEST_F(WithRoles, LiveReadersAreSentAwayWithTheirToken) {
  const std::string viewer = make(v1::ROLE_VIEWER, "vera");
  HttpClient::Events events(*world.client, "/api/v1/events", with(viewer));
  ASSERT_EQ(events.next().name, "snapshot");
  StoredToken row;
  ASSERT_TRUE(world.farm.authority->revoke(id, row).ok());
  for (auto event = events.next(); !event.name.empty(); event = events.next()) {
  }
  HttpClient::Events again(*world.client, "/api/v1/events", with(viewer));
  EXPECT_EQ(again.status(), 401);
}

TEST(Authenticator, PagesOfOtherSitesMayNotSteer) {
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

TEST(Authenticator, NamesThatAreNotThisMachinesAreRefusedWhereNothingElseGuards) {
  WebWorld world;
  world.start();
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Host", "evil.example:8080"}}).status, 403);
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Host", "localhost"}}).status, 200);
  EXPECT_EQ(world.client->get("/api/v1/info", {{"Host", "localhost:99"}}).status, 200);
}

TEST(Authenticator, ANameThatAStrangerMayHaveIsRefusedBeyondThisMachineToo) {
  WebWorld world;
  world.farm.how.insecure = true;
  world.names = {"Farm.Example"};
  world.start("0.0.0.0:0");
  const auto as = [&](const std::string& host) {
    return world.client->get("/api/v1/info", {{"Host", host}}).status;
  };
  for (const char* ours : {"192.0.2.7:8080", "192.0.2.7", "[2001:db8::1]:8080", "[::1]",
                           "farm:8080", "node-7.local", "farm.example", "FARM.example:8080"}) {
    EXPECT_EQ(as(ours), 200) << ours;
  }
  for (const char* strange :
       {"evil.example", "farm.example.evil.example:8080", "192.0.2.7.evil.example", "1.2.3",
        "[::1].evil.example", "farm.local.evil.example", "x.", "."}) {
    EXPECT_EQ(as(strange), 403) << strange;
  }
  // Tokens guard by themselves: a page of another name has no cookie of ours.
  std::string text;
  StoredToken row;
  ASSERT_TRUE(world.farm.authority->create("root", v1::ROLE_ADMIN, 0, text, row).ok());
  EXPECT_EQ(as("evil.example"), 401);
}

TEST(Authenticator, BeyondThisMachineOnlyWithTlsAndToken) {
  FarmWorld farm;
  farm.start();
  farm::Listen listen;
  listen.address = "0.0.0.0:0";
  EXPECT_FALSE(WebServer::start(listen, *farm.controller, *farm.authority).ok());
}

TEST(WebServer, AnAddressThatIsTakenIsTold) {
  WebWorld world;
  world.start();
  farm::Listen listen;
  listen.address = world.web->url().substr(7);
  const auto second = WebServer::start(listen, *world.farm.controller, *world.farm.authority);
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find(listen.address), std::string::npos);
}

/// At one that was left another user could take our place.
TEST(WebServer, ListensAtAllThatANameStandsFor) {
  WebWorld world;
  world.start();
  farm::Listen listen;
  listen.address = "localhost:0";
  const auto second = WebServer::start(listen, *world.farm.controller, *world.farm.authority);
  ASSERT_TRUE(second.ok()) << second.error().message;
  const std::string port = (*second)->url().substr((*second)->url().rfind(':'));
  EXPECT_FALSE(listen_at({"127.0.0.1" + port}).ok());
  EXPECT_FALSE(listen_at({"[::1]" + port}).ok());
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
      world.client
          ->exchange("PUT / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n")
          .find(" 413 "),
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
