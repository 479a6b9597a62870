// Submit, watch, look, download: over HTTP.
#include <gtest/gtest.h>

#include "core/image/read_image.h"
#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

using farm::Json;

TEST(WebSpine, AJobIsSubmittedWatchedLookedAtAndDownloaded) {
  WebWorld world;
  world.start();
  const std::string document = FarmWorld::document(3);
  const Json wanted = {{"files", WebWorld::submission(document)["files"]}};
  const auto missing = world.client->post("/api/v1/assets/missing", wanted.dump());
  ASSERT_EQ(missing.status, 200) << missing.body;
  ASSERT_EQ(Json::parse(missing.body)["missing"].size(), 1U);
  const auto early = world.client->post("/api/v1/jobs", WebWorld::submission(document).dump());
  EXPECT_EQ(early.status, 409);
  EXPECT_EQ(Json::parse(early.body)["error"]["missing"].size(), 1U);
  world.upload(document);
  const auto submitted = world.client->post("/api/v1/jobs", WebWorld::submission(document).dump());
  ASSERT_EQ(submitted.status, 201) << submitted.body;
  const uint64_t job = Json::parse(submitted.body)["job"]["id"];
  const std::string path = "/api/v1/jobs/" + std::to_string(job);

  HttpClient::Events events(*world.client, path + "/events");
  ASSERT_EQ(events.status(), 200);
  const auto first = events.next();
  ASSERT_EQ(first.name, "snapshot");
  EXPECT_EQ(Json::parse(first.data)["frames"].size(), 3U);
  const ScriptedWorker worker(world.farm.address, world.farm.script());
  Json last;
  std::string name;
  for (;;) {
    const auto event = events.next();
    ASSERT_FALSE(event.name.empty()) << "the stream ended before the job did";
    name = event.name;
    last = Json::parse(event.data);
    if (name == "end") break;
  }
  EXPECT_EQ(last["job"]["state"], "done");
  EXPECT_TRUE(events.next().name.empty());

  const Json now = world.json(path);
  EXPECT_EQ(now["job"]["frames_done"], 3);
  EXPECT_EQ(now["frames"][2]["state"], "done");
  const Json outputs = world.json(path + "/outputs")["outputs"];
  ASSERT_EQ(outputs.size(), 6U);
  for (const Json& output : outputs) {
    const auto file = world.client->get(path + "/outputs/" + output["id"].get<std::string>());
    ASSERT_EQ(file.status, 200);
    EXPECT_EQ(core::to_hex(core::sha256(file.body)), output["sha256"].get<std::string>());
  }
  const std::string file = path + "/outputs/balls.0001.exr";
  const auto part = world.client->get(file, {{"Range", "bytes=0-3"}});
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.body, "\x76\x2f\x31\x01") << "the first bytes of every EXR";
  EXPECT_EQ(world.client->get(file, {{"Range", "bytes=999999999-"}}).status, 416);
  const auto archive = world.client->get(path + "/archive.zip");
  EXPECT_TRUE(archive.whole);
  EXPECT_EQ(archive.body.substr(0, 2), "PK");
  EXPECT_EQ(world.client->get(path + "/document").body, document);
  EXPECT_GE(world.json(path + "/logs")["lines"].size(), 1U);
}

TEST(WebSpine, AFrameInMidRenderIsShownAndRefines) {
  WebWorld world;
  world.farm.options.unit_time = std::chrono::milliseconds(1);
  world.start();
  const uint64_t job = world.farm.submit(1);
  const std::string picture =
      "/api/v1/jobs/" + std::to_string(job) + "/frames/1/picture?format=half&layer=samples";
  EXPECT_EQ(world.client->get(picture).status, 503) << "nothing of it is there yet";
  ScriptedWorker::Script script = world.farm.script();
  script.unit_time = std::chrono::milliseconds(60);
  const ScriptedWorker worker(world.farm.address, script);
  std::set<uint64_t> seen;
  ASSERT_TRUE(eventually([&] {
    const auto response = world.client->get(picture);
    if (response.status != 200) return seen.size() > 1;
    const Json header = Json::parse(response.body.substr(0, response.body.find('\n')));
    EXPECT_EQ(header["width"], FarmWorld::kWidth);
    EXPECT_EQ(header["channels"].size(), 1U);
    EXPECT_EQ(response.body.size() - response.body.find('\n') - 1,
              static_cast<size_t>(FarmWorld::kWidth * FarmWorld::kHeight * 2));
    seen.insert(header["samples"].get<uint64_t>());
    return seen.size() > 1;
  }));
}

TEST(WebSpine, AFinishedFrameIsShownSmall) {
  WebWorld world;
  world.start();
  const uint64_t job = world.farm.submit(1);
  const ScriptedWorker worker(world.farm.address, world.farm.script());
  ASSERT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_DONE));
  const std::string picture = "/api/v1/jobs/" + std::to_string(job) + "/frames/1/picture";
  const auto response = world.client->get(picture + "?width=20");
  ASSERT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(response.headers.at("content-type"), "image/png");
  const auto owned = std::make_shared<const std::string>(response.body);
  const auto image =
      core::read_image(core::Bytes(owned, std::as_bytes(std::span(*owned))), "picture");
  ASSERT_TRUE(image.ok()) << (image ? "" : image.error().message);
  EXPECT_EQ(image->width, 20);
  EXPECT_EQ(image->height, 12);
  EXPECT_EQ(
      world.client->get(picture + "?width=20", {{"If-None-Match", response.headers.at("etag")}})
          .status,
      304);
}

TEST(WebSpine, JobsAreSteered) {
  WebWorld world;
  world.start();
  const uint64_t job = world.farm.submit(2);
  const std::string path = "/api/v1/jobs/" + std::to_string(job);
  const auto state_after = [&](const std::string& action) {
    const auto response = world.client->post(path + "/" + action);
    EXPECT_EQ(response.status, 200) << response.body;
    return Json::parse(response.body)["state"].get<std::string>();
  };
  EXPECT_EQ(state_after("pause"), "paused");
  EXPECT_EQ(state_after("resume"), "running");
  const auto priority = world.client->send("PUT", path + "/priority", R"({"priority": 7})");
  EXPECT_EQ(Json::parse(priority.body)["priority"], 7);
  EXPECT_GE(world.json(path + "/explain")["reasons"].size(), 1U);
  EXPECT_EQ(world.client->send("DELETE", path).status, 409) << "it has not ended";
  EXPECT_EQ(state_after("cancel"), "cancelled");
  EXPECT_EQ(world.json("/api/v1/jobs")["jobs"].size(), 0U);
  EXPECT_EQ(world.json("/api/v1/jobs?ended=true")["jobs"].size(), 1U);
  EXPECT_EQ(state_after("retry"), "running");
  EXPECT_EQ(state_after("cancel"), "cancelled");
  EXPECT_TRUE(eventually([&] { return world.client->send("DELETE", path).status == 204; }));
  EXPECT_EQ(world.client->get(path).status, 404);
  EXPECT_EQ(world.client->get(path + "/events").status, 404);
}

TEST(WebSpine, TheFarmIsToldAsItChanges) {
  WebWorld world;
  world.start();
  HttpClient::Events events(*world.client, "/api/v1/events");
  ASSERT_EQ(events.status(), 200);
  const auto first = events.next();
  ASSERT_EQ(first.name, "snapshot");
  EXPECT_EQ(Json::parse(first.data)["workers"].size(), 0U);
  bool worker_came = false;
  bool worker_went = false;
  bool job_came = false;
  bool job_ended = false;
  uint64_t job = 0;
  std::optional<ScriptedWorker> worker;
  while (!job_ended || !worker_went) {
    if (job == 0) job = world.farm.submit(1);
    const auto event = events.next();
    ASSERT_EQ(event.name, "change") << worker_came << worker_went << job_came << job_ended;
    const Json change = Json::parse(event.data);
    if (change.contains("jobs")) {
      for (const Json& one : change["jobs"]) {
        job_came = job_came || one["id"] == job;
        // Of a row that is known only what has changed is told.
        job_ended = job_ended || one.value("state", "") == "done";
      }
    }
    if (change.contains("workers")) {
      for (const Json& one : change["workers"]) {
        const std::string state = one.value("state", "");
        worker_came = worker_came || state == "active";
        worker_went = worker_went || state == "gone";
      }
    }
    if (job_came && !worker) worker.emplace(world.farm.address, world.farm.script());
    if (job_ended && worker_came) worker.reset();
  }
  EXPECT_TRUE(worker_came);
  EXPECT_TRUE(job_came);
}

}  // namespace
}  // namespace hyades::coordinator
