// Videos that somebody asks for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <fstream>
#include <string>
#include <vector>

#include "core/base/child_process.h"
#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

using farm::Json;

core::Job job_with(const std::vector<std::string>& files) {
  core::Job job;
  job.name = "two balls";
  job.frames.first = 1;
  job.frames.last = 3;
  for (const std::string& file : files) {
    core::OutputDesc output;
    output.file = file;
    job.outputs.push_back(output);
  }
  return job;
}

TEST(RequestedVideo, IsMadeOfTheFirstPicturesForDisplays) {
  const core::Job job = job_with({"a.####.exr", "a.####.png"});
  const auto asked = plan_video(job, {}, {1, 2, 3}, {"a.0001.exr", "a.0001.png", "a.0003.png"});
  ASSERT_TRUE(asked.ok()) << (asked ? "" : asked.error().message);
  EXPECT_EQ(asked->video.file, "two-balls.mp4");
  EXPECT_EQ(asked->video.pictures, "a.####.png");
  EXPECT_EQ(asked->frames.numbers, (std::vector<int32_t>{1, 3})) << "whose picture is there";
}

TEST(RequestedVideo, WhatCannotBeIsTold) {
  core::Job job = job_with({"a.####.exr", "b/a.####.png"});
  job.videos.emplace_back().file = "own.mp4";
  const std::vector<std::string> files{"b/a.0001.png"};
  const auto error = [&](const VideoRequest& request, const std::vector<std::string>& there) {
    const auto asked = plan_video(job, request, {1}, there);
    return asked ? std::string("none") : asked.error().message;
  };
  EXPECT_EQ(error({}, files), "none");
  EXPECT_NE(error({"film.avi", "", 0}, files).find(".mp4"), std::string::npos);
  EXPECT_NE(error({"../film.mp4", "", 0}, files).find("below"), std::string::npos);
  EXPECT_NE(error({"a/../../film.mp4", "", 0}, files).find("below"), std::string::npos);
  EXPECT_NE(error({"film\n.mp4", "", 0}, files).find("below"), std::string::npos);
  EXPECT_NE(error({"/film.mp4", "", 0}, files).find("below"), std::string::npos);
  for (const char* file : {".hyades/film.mp4", "a/.b/film.mp4", "-a/film.mp4", "-film.mp4"}) {
    EXPECT_NE(error({file, "", 0}, files).find("below"), std::string::npos) << file;
  }
  EXPECT_NE(error({"own.mp4", "", 0}, files).find("makes that video itself"), std::string::npos);
  EXPECT_NE(error({"b/a.0001.png/x.mp4", "", 0}, files).find("writes"), std::string::npos);
  EXPECT_NE(error({"f.####.mp4", "", 0}, files).find("expected"), std::string::npos);
  EXPECT_NE(error({"", "c.####.png", 0}, files).find("writes no"), std::string::npos);
  EXPECT_NE(error({"", "a.####.exr", 0}, files).find("PNG, JPEG"), std::string::npos);
  EXPECT_NE(error({"", "", -1}, files).find("rate"), std::string::npos);
  EXPECT_NE(error({"", "", 1e9}, files).find("rate"), std::string::npos);
  EXPECT_NE(error({}, {}).find("no picture"), std::string::npos);
}

TEST(Videos, AreMadeOfAFinishedJob) {
  WebWorld world;
  world.start();
  const uint64_t job = world.farm.submit(3);
  const std::string path = "/api/v1/jobs/" + std::to_string(job);
  EXPECT_EQ(world.client->post(path + "/videos").status, 409) << "no frame is done";
  EXPECT_EQ(world.client->post("/api/v1/jobs/99/videos").status, 404);
  EXPECT_EQ(world.client->post(path + "/videos", R"({"size": 3})").status, 400);
  const ScriptedWorker worker(world.farm.address, world.farm.script());
  ASSERT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_DONE));
  const auto asked = world.client->post(path + "/videos", R"({"file": "film.mp4", "rate": 12})");
  ASSERT_EQ(asked.status, 202) << asked.body;
  EXPECT_EQ(Json::parse(asked.body)["frames"], 3);
  EXPECT_EQ(Json::parse(asked.body)["rate"], 12);
  Json video;
  ASSERT_TRUE(eventually([&] {
    video = world.json(path + "/videos")["videos"][0];
    return video["state"] == "done" || video["state"] == "failed";
  }));
  if (!core::find_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not here";
  ASSERT_EQ(video["state"], "done") << video;
  bool found = false;
  const Json outputs = world.json(path + "/outputs")["outputs"];
  for (const Json& output : outputs) {
    found = found || output["id"] == "film.mp4";
  }
  EXPECT_TRUE(found);
  const auto bytes = world.client->get(path + "/outputs/film.mp4");
  EXPECT_EQ(bytes.status, 200);
  EXPECT_EQ(bytes.headers.at("content-type"), "video/mp4");
  EXPECT_EQ(bytes.body.substr(4, 4), "ftyp");
  EXPECT_EQ(world.client->send("DELETE", path).status, 204);
  EXPECT_EQ(world.client->get(path + "/videos").status, 404);
}

/// A coordinator whose videos are begun with, but not made before go() was called. Its finished
/// frames are finished at once.
class SlowVideos : public ::testing::Test {
 protected:
  SlowVideos() {
    const std::string program = world.farm.folder.file("slow_finisher");
    std::ofstream(program) << "#!/bin/sh\n"
                           << "if [ \"$1\" = video ]; then\n"
                           << "  echo \"$2\" >>" << begun_ << "\n"
                           << "  until [ -e " << go_ << " ]; do sleep 0.02; done\n"
                           << "fi\n"
                           << "exec " << world.farm.options.finisher << " \"$@\"\n";
    EXPECT_EQ(::chmod(program.c_str(), 0700), 0);
    world.farm.options.finisher = program;
    world.start();
  }

  /// A job of the owner's, once its frames are finished.
  uint64_t finished_job(const std::string& owner) {
    const uint64_t job =
        world.farm.submit(1, [&](v1::SubmitRequest& request) { request.set_owner(owner); });
    const ScriptedWorker worker(world.farm.address, world.farm.script());
    EXPECT_TRUE(world.farm.wait_for(job, v1::JOB_STATE_DONE));
    return job;
  }
  /// Asks for the owner's N-th video of the job; what is answered.
  int ask(uint64_t job, int number) const {
    return world.client
        ->post("/api/v1/jobs/" + std::to_string(job) + "/videos",
               R"({"file": ")" + std::to_string(number) + R"(.mp4"})")
        .status;
  }
  void go() const { std::ofstream(go_) << "go"; }
  /// The jobs of whose videos one was begun with, in that order.
  std::vector<uint64_t> begun() const {
    std::vector<uint64_t> jobs;
    std::ifstream file(begun_);
    for (std::string line; std::getline(file, line);) {
      jobs.push_back(std::stoull(line.substr(line.rfind('/') + 1)));
    }
    return jobs;
  }

  WebWorld world;

 private:
  const std::string begun_ = world.farm.folder.file("begun");
  const std::string go_ = world.farm.folder.file("go");
};

TEST_F(SlowVideos, OwnersTakeTurnsAndNobodyFillsTheRow) {
  const uint64_t many = finished_job("ada");
  const uint64_t one = finished_job("bob");
  for (int i = 0; i < 8; ++i) EXPECT_EQ(ask(many, i), 202) << i;
  EXPECT_EQ(ask(many, 8), 503) << "eight of one owner's wait";
  EXPECT_EQ(ask(one, 0), 202) << "there is room for others";
  ASSERT_TRUE(eventually([&] { return begun().size() == 2; }));
  EXPECT_THAT(begun(), testing::UnorderedElementsAre(many, one))
      << "of each owner one is made at a time";
  go();
  ASSERT_TRUE(eventually([&] { return begun().size() == 9; }));
}

TEST_F(SlowVideos, ThatAreAskedForTakeTurnsWithThoseOfJobs) {
  const uint64_t one = finished_job("bob");
  const auto with_video = [&](uint64_t already) {
    std::string document = FarmWorld::document(1);
    document.replace(document.rfind(']'), 1, ", {file: own.mp4}]");
    const uint64_t job = world.farm.submit_text(
        document, [](v1::SubmitRequest& request) { request.set_owner("ada"); });
    const ScriptedWorker worker(world.farm.address, world.farm.script());
    EXPECT_TRUE(eventually([&] { return world.farm.get(job).job().frames_done() == 1; }));
    EXPECT_TRUE(eventually([&] { return begun().size() == already; }));
    return job;
  };
  const uint64_t first = with_video(1);
  const uint64_t second = with_video(1);
  EXPECT_EQ(ask(one, 0), 202);
  go();
  ASSERT_TRUE(eventually([&] { return begun().size() == 3; }));
  EXPECT_EQ(begun(), (std::vector<uint64_t>{first, one, second}));
}

}  // namespace
}  // namespace hyades::coordinator
