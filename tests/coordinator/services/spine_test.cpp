// Submit, lease, render, deliver, merge, finish, fetch: over real gRPC.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

TEST(Spine, AJobIsRenderedAndFetched) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(3);
  const ScriptedWorker worker(world.address, world.script());
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  const v1::GetJobResponse now = world.get(job);
  EXPECT_EQ(now.job().frames_done(), 3U);
  EXPECT_EQ(now.job().samples_done(), now.job().samples());
  ASSERT_EQ(now.frames_size(), 3);
  EXPECT_EQ(now.frames(0).worker_class(), "class-a");
  for (int frame = 1; frame <= 3; ++frame) world.expect_truth(job, frame);
  EXPECT_TRUE(eventually([&] { return worker.unacknowledged() == 0; }));
}

TEST(Spine, ManyWorkersOfWhichSomeVanishGiveTheSameBits) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(6);
  std::vector<std::unique_ptr<ScriptedWorker>> workers;
  for (int i = 0; i < 4; ++i) {
    ScriptedWorker::Script script = world.script(i);
    script.unit_time = std::chrono::milliseconds(2);
    workers.push_back(std::make_unique<ScriptedWorker>(world.address, script));
  }
  for (int i = 4; i < 12; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    workers.erase(workers.begin());
    ScriptedWorker::Script script = world.script(i);
    script.unit_time = std::chrono::milliseconds(1);
    workers.push_back(std::make_unique<ScriptedWorker>(world.address, script));
  }
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  for (int frame = 1; frame <= 6; ++frame) world.expect_truth(job, frame);
}

TEST(Spine, ARestartedCoordinatorTakesItsJobsUpAgain) {
  FarmWorld world;
  world.options.unit_time = std::chrono::milliseconds(1);  // a batch: so there are many units
  world.start();
  const uint64_t job = world.submit(4);
  ScriptedWorker::Script script = world.script();
  script.unit_time = std::chrono::milliseconds(4);
  const ScriptedWorker worker(world.address, script);
  for (int life = 0; life < 3; ++life) {
    const uint64_t before = worker.acknowledged();
    ASSERT_TRUE(eventually([&] { return worker.acknowledged() >= before + 6; }));
    const uint64_t done = world.get(job).job().samples_done();
    world.stop();
    world.start();
    EXPECT_GE(world.get(job).job().samples_done(), done) << "what was durable is there again";
  }
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  EXPECT_GE(worker.streams(), 4U);
  for (int frame = 1; frame <= 4; ++frame) world.expect_truth(job, frame);
  v1::InfoResponse info;
  ASSERT_TRUE(world.farm_->Info(world.context().get(), {}, &info).ok());
  EXPECT_EQ(info.incarnation(), 4U);
}

TEST(Spine, JobsThatAStartHasNoTimeForGoOnAfterwards) {
  FarmWorld world;
  world.options.unit_time = std::chrono::milliseconds(1);
  world.start();
  const uint64_t first = world.submit(2);
  const uint64_t second = world.submit(2);
  ScriptedWorker::Script script = world.script();
  script.unit_time = std::chrono::milliseconds(4);
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(eventually([&] { return worker.acknowledged() >= 6; }));
  world.stop();
  world.options.recovery_time = std::chrono::seconds(0);
  world.start();
  for (const uint64_t job : {first, second}) {
    ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
    EXPECT_EQ(world.get(job).job().reason(), "");
    for (int frame = 1; frame <= 2; ++frame) world.expect_truth(job, frame);
  }
}

TEST(Spine, OutputsThatAreDamagedBetweenTwoLivesAreMadeAgain) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(8);
  ScriptedWorker::Script script = world.script();
  script.unit_time = std::chrono::milliseconds(10);
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(eventually([&] { return world.get(job).job().frames_done() >= 2; }));
  world.stop();
  const std::string outputs = world.options.folder + "/outputs/" + std::to_string(job) + "/";
  std::filesystem::remove(outputs + "balls.0001.png");
  std::filesystem::resize_file(outputs + "balls.0002.exr", 100);
  world.start();
  EXPECT_EQ(world.get(job).frames(0).restarts(), 1U);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  world.expect_truth(job, 1);
  world.expect_truth(job, 2);
  EXPECT_FALSE(world.fetch(job, "balls.0001.png").empty());
}

TEST(Spine, WatchTellsTheWholeStory) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(2);
  v1::WatchRequest request;
  request.set_job(job);
  const auto context = world.context();
  const auto reader = world.jobs->Watch(context.get(), request);
  v1::WatchEvent event;
  ASSERT_TRUE(reader->Read(&event));
  EXPECT_EQ(event.job().state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(event.changed_size(), 2);
  const ScriptedWorker worker(world.address, world.script());
  uint64_t done = 0;
  while (reader->Read(&event)) {
    EXPECT_GE(event.job().samples_done(), done);
    done = event.job().samples_done();
  }
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_EQ(event.job().state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(event.job().frames_done(), 2U);

  v1::OutputsRequest outputs;
  outputs.set_job(job);
  const auto listing = world.context();
  const auto files = world.jobs->Outputs(listing.get(), outputs);
  v1::OutputFile file;
  int count = 0;
  for (; files->Read(&file); ++count) {
    const std::string bytes = world.fetch(job, file.path());
    EXPECT_EQ(bytes.size(), file.size());
    EXPECT_EQ(farm::to_wire(core::sha256(bytes)), file.sha256());
  }
  EXPECT_EQ(count, 4);
}

}  // namespace
}  // namespace hyades::coordinator
