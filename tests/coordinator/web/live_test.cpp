// Live events: readers that come early, late, together; jobs that are deleted; a server that ends
// under load.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

using farm::Json;

/// What a reader knows of frames when the stream has ended.
std::map<int, std::string> frames_at_end(HttpClient::Events& events, std::string& last) {
  std::map<int, std::string> frames;
  for (auto event = events.next(); !event.name.empty(); event = events.next()) {
    last = event.name;
    const Json data = Json::parse(event.data);
    if (!data.contains("frames")) continue;
    for (const Json& frame : data["frames"]) frames[frame["id"].get<int>()] = frame["state"];
  }
  return frames;
}

TEST(Live, ReadersThatComeAtAnyTimeEndWithTheSame) {
  WebWorld world;
  world.farm.options.unit_time = 1ms;
  world.start();
  const uint64_t job = world.farm.submit(12);
  const std::string path = "/api/v1/jobs/" + std::to_string(job) + "/events";
  ScriptedWorker::Script script = world.farm.script();
  script.unit_time = 2ms;
  const ScriptedWorker worker(world.farm.address, script);
  std::vector<std::thread> readers;
  std::atomic<int> wrong{0};
  for (int i = 0; i < 24; ++i) {
    readers.emplace_back([&, i] {
      std::this_thread::sleep_for(std::chrono::milliseconds(120 * i));
      HttpClient::Events events(*world.client, path);
      std::string last;
      const auto frames = frames_at_end(events, last);
      const bool all = frames.size() == 12 && last == "end" &&
                       std::all_of(frames.begin(), frames.end(),
                                   [](const auto& frame) { return frame.second == "done"; });
      if (!all) ++wrong;
    });
  }
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(wrong, 0);
}

// More frames than are read at once.
TEST(Live, ASnapshotOfManyFramesIsOneEvent) {
  WebWorld world;
  world.start();
  const uint64_t job = world.farm.submit(5000);
  const std::string path = "/api/v1/jobs/" + std::to_string(job);
  HttpClient::Events early(*world.client, path + "/events");
  HttpClient::Events late(*world.client, path + "/events");
  for (HttpClient::Events* events : {&early, &late}) {
    const auto first = events->next();
    ASSERT_EQ(first.name, "snapshot");
    const Json data = Json::parse(first.data);
    EXPECT_EQ(data["job"]["id"], job);
    std::set<int> frames;
    for (const Json& frame : data["frames"]) frames.insert(frame["id"].get<int>());
    EXPECT_EQ(frames.size(), 5000U);
    EXPECT_EQ(data["frames"].size(), 5000U) << "each once";
  }
  ASSERT_EQ(world.client->post(path + "/cancel").status, 200);
  for (HttpClient::Events* events : {&early, &late}) {
    std::string last;
    frames_at_end(*events, last);
    EXPECT_EQ(last, "end") << "they hear what comes after their snapshots";
  }
  HttpClient::Events over(*world.client, path + "/events");
  EXPECT_EQ(over.next().name, "snapshot");
  EXPECT_EQ(over.next().name, "end");
  EXPECT_EQ(over.next().name, "") << "and the stream is over";
}

// Versions of a job begin anew when it is opened again.
TEST(Live, WhoHeardOfAJobBeforeItWasOpenedAgainHearsAllOfIt) {
  WebWorld world;
  world.start();
  const uint64_t job = world.farm.submit(3);
  ChangeCursor cursor;
  const auto frames_told = [&] {
    size_t count = 0;
    for (bool more = true; more;) {
      v1::WatchEvent event;
      bool ended = false;
      const auto status = world.farm.controller->queries().changes(job, cursor, event, ended);
      EXPECT_TRUE(status.ok()) << status.error_message();
      count += static_cast<size_t>(event.changed_size());
      more = event.more();
    }
    return count;
  };
  EXPECT_EQ(frames_told(), 3U);
  cursor.version += 1000;  // as if much had happened
  EXPECT_EQ(frames_told(), 0U);
  const std::string path = "/api/v1/jobs/" + std::to_string(job);
  ASSERT_EQ(world.client->post(path + "/cancel").status, 200);
  ASSERT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_CANCELLED));
  ASSERT_EQ(world.client->post(path + "/retry").status, 200);
  EXPECT_EQ(frames_told(), 3U);
}

// What is in its way, and that somebody has paused it, changes no frame.
TEST(Live, WhoWatchesAJobHearsWhatChangesOfItAlone) {
  WebWorld world;
  world.start();
  const uint64_t job = world.farm.submit(2);
  v1::WatchRequest asked;
  asked.set_job(job);
  const auto context = world.farm.context();
  const auto watch = world.farm.jobs->Watch(context.get(), asked);
  v1::WatchEvent event;
  const auto hears = [&](const auto& what) {
    while (watch->Read(&event)) {
      if (what(event.job())) return true;
    }
    return false;
  };
  EXPECT_TRUE(hears([](const v1::Job& told) { return !told.reason().empty(); })) << "no worker";
  v1::JobRequest about;
  about.set_job(job);
  v1::JobResponse paused;
  ASSERT_TRUE(world.farm.jobs->Pause(world.farm.context().get(), about, &paused).ok());
  EXPECT_TRUE(hears([](const v1::Job& told) { return told.state() == v1::JOB_STATE_PAUSED; }));
  context->TryCancel();
}

TEST(Live, WhoReadsAJobThatIsDeletedIsToldSo) {
  WebWorld world;
  world.start();
  const uint64_t job = world.farm.submit(1);
  const std::string path = "/api/v1/jobs/" + std::to_string(job);
  HttpClient::Events events(*world.client, path + "/events");
  ASSERT_EQ(events.next().name, "snapshot");
  ASSERT_EQ(world.client->post(path + "/cancel").status, 200);
  ASSERT_TRUE(eventually([&] { return world.client->send("DELETE", path).status == 204; }));
  std::string last;
  frames_at_end(events, last);
  EXPECT_TRUE(last == "gone" || last == "end") << last;
}

TEST(Live, AServerThatEndsUnderLoadEndsCleanly) {
  for (int round = 0; round < 5; ++round) {
    WebWorld world;
    world.farm.options.unit_time = 1ms;
    world.start();
    const uint64_t job = world.farm.submit(6);
    ScriptedWorker::Script script = world.farm.script();
    script.unit_time = 1ms;
    const ScriptedWorker worker(world.farm.address, script);
    const std::string path = "/api/v1/jobs/" + std::to_string(job);
    std::atomic<bool> stop{false};
    std::vector<std::thread> people;
    for (int i = 0; i < 6; ++i) {
      people.emplace_back([&, i] {
        for (int k = 0; !stop; ++k) {
          const std::string frame = std::to_string(1 + (i + k) % 6);
          world.client->get(path + "/frames/" + frame + "/picture?width=" + std::to_string(16 + k));
          world.client->get(path + "/archive.zip");
          if (i == 0) HttpClient::Events(*world.client, path + "/events").next();
        }
      });
    }
    std::this_thread::sleep_for(200ms);
    world.farm.controller->stop();
    world.web.reset();
    stop = true;
    for (std::thread& person : people) person.join();
  }
}

TEST(Live, PicturesOfOneFrameForManyAskCopyItsFilmOnce) {
  WebWorld world;
  world.farm.options.unit_time = 1ms;
  world.start();
  const uint64_t job = world.farm.submit(1);
  ScriptedWorker::Script script = world.farm.script();
  script.unit_time = 40ms;
  const ScriptedWorker worker(world.farm.address, script);
  const std::string path = "/api/v1/jobs/" + std::to_string(job) + "/frames/1/picture?width=";
  ASSERT_TRUE(eventually([&] { return world.client->get(path + "40").status == 200; }));
  std::set<std::string> stamps;
  for (int i = 0; i < 20; ++i) {
    const auto response = world.client->get(path + "40");
    if (response.status == 200) stamps.insert(response.headers.at("hyades-stamp"));
  }
  EXPECT_LE(stamps.size(), 4U) << "at most one a second";
}

TEST(Live, BodiesAreNotReadWithoutTheRight) {
  WebWorld world;
  world.start();
  const std::string large(300'000, 'a');
  EXPECT_EQ(world.client->post("/api/v1/jobs/1/cancel", large).status, 413);
  EXPECT_EQ(world.client->post("/api/v1/session", large).status, 413);
  EXPECT_EQ(world.client->post("/api/v1/jobs", large, {{"Origin", "https://evil.example"}}).status,
            403);
  EXPECT_EQ(world.client->get("/api/v1/info").status, 200);
}

}  // namespace
}  // namespace hyades::coordinator
