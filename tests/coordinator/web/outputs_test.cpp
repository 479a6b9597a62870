// Lists of finished files, page by page.
#include <gtest/gtest.h>

#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

using farm::Json;

class Outputs : public ::testing::Test {
 protected:
  void SetUp() override {
    world.start();
    const uint64_t job = world.farm.submit(3);
    const ScriptedWorker worker(world.farm.address, world.farm.script());
    ASSERT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_DONE));
    path = "/api/v1/jobs/" + std::to_string(job) + "/outputs";
  }
  WebWorld world;
  std::string path;
};

TEST_F(Outputs, PagesHoldEachFileOnce) {
  const Json whole = world.json(path);
  const size_t count = whole["outputs"].size();
  ASSERT_GE(count, 3U);
  Json page = world.json(path + "?limit=2");
  EXPECT_EQ(page["outputs"].size(), 2U);
  EXPECT_EQ(page["more"], true);
  Json all = page["outputs"];
  for (size_t pages = 1; page["more"] == true; ++pages) {
    ASSERT_LT(pages, 2 + count) << "they do not end";
    page = world.json(path + "?limit=2&after=" + page["after"].dump());
    for (const Json& output : page["outputs"]) all.push_back(output);
  }
  EXPECT_EQ(all, whole["outputs"]);
  EXPECT_TRUE(world.json(path + "?after=" + whole["after"].dump())["outputs"].empty());
}

TEST_F(Outputs, OfOneFrame) {
  size_t sum = 0;
  for (int frame = 1; frame <= 3; ++frame) {
    const Json of_frame = world.json(path + "?frame=" + std::to_string(frame));
    EXPECT_EQ(of_frame["more"], false);
    for (const Json& output : of_frame["outputs"]) EXPECT_EQ(output["frame"], frame);
    sum += of_frame["outputs"].size();
  }
  EXPECT_EQ(sum, world.json(path)["outputs"].size());
  EXPECT_TRUE(world.json(path + "?frame=9")["outputs"].empty());
}

TEST_F(Outputs, WhatIsNoNumberIsTold) {
  for (const char* wrong :
       {"?after=x", "?limit=-1", "?frame=1.5", "?limit=99999999999", "?limit=0"}) {
    EXPECT_EQ(world.client->get(path + wrong).status, 400) << wrong;
  }
}

// A job may write "a.PNG", which is a picture for jobs, but was none here.
TEST(Pictures, AreFoundWhereTheirEndingsAreCapitals) {
  WebWorld world;
  world.start();
  std::string document = FarmWorld::document(1);
  document.erase(document.find("outputs:"));
  const uint64_t job = world.farm.submit_text(document + "outputs: [{file: balls.####.PNG}]\n");
  const ScriptedWorker worker(world.farm.address, world.farm.script());
  ASSERT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_DONE));
  const std::string path = "/api/v1/jobs/" + std::to_string(job);
  const auto shown = world.client->get(path + "/frames/1/picture");
  EXPECT_EQ(shown.status, 200) << shown.body;
  const auto file = world.client->get(path + "/outputs/balls.0001.PNG");
  ASSERT_EQ(file.status, 200) << file.body;
  EXPECT_EQ(file.headers.at("content-type"), "image/png");
}

}  // namespace
}  // namespace hyades::coordinator
