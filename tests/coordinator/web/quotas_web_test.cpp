// Who has as much as an owner may have is told so over HTTP: 429, where a busy coordinator says
// 503.
#include <gtest/gtest.h>

#include <string>

#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

TEST(QuotasOverHttp, OfJobs) {
  WebWorld world;
  world.farm.options.per_owner.jobs = 1;
  world.start();
  const std::string document = FarmWorld::document(1);
  (void)world.upload(document);
  farm::Json job = WebWorld::submission(document);
  EXPECT_EQ(world.client->post("/api/v1/jobs", job.dump()).status, 201);
  const HttpClient::Response refused = world.client->post("/api/v1/jobs", job.dump());
  EXPECT_EQ(refused.status, 429) << refused.body;
  const farm::Json error = farm::Json::parse(refused.body)["error"];
  EXPECT_EQ(error["code"], "resource_exhausted");
  EXPECT_NE(error["message"].get<std::string>().find("--owner-jobs 1"), std::string::npos);
  EXPECT_FALSE(error.contains("retry_after_ms")) << "it does not pass by itself";
  job["owner"] = "bob";
  EXPECT_EQ(world.client->post("/api/v1/jobs", job.dump()).status, 201);
}

TEST(QuotasOverHttp, OfConnections) {
  WebWorld world;
  world.farm.options.per_owner.connections = 1;
  world.start();
  std::string root;
  StoredToken row;
  ASSERT_TRUE(world.farm.authority->create("root", v1::ROLE_ADMIN, 0, root, row).ok());
  const HttpClient::Headers shown = {{"Authorization", "Bearer " + root}};
  {
    HttpClient::Events feed(*world.client, "/api/v1/events", shown);
    EXPECT_FALSE(feed.next().name.empty());
    const HttpClient::Response refused = world.client->get("/api/v1/events", shown);
    EXPECT_EQ(refused.status, 429) << refused.body;
    EXPECT_NE(refused.body.find("--owner-connections 1"), std::string::npos) << refused.body;
    EXPECT_EQ(world.client->get("/api/v1/jobs", shown).status, 200) << "what is no stream";
  }
  EXPECT_TRUE(eventually([&] {
    HttpClient::Events again(*world.client, "/api/v1/events", shown);
    return again.status() == 200;
  }));
}

}  // namespace
}  // namespace hyades::coordinator
