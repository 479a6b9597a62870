// Films of all jobs together have so much memory.
#include <gmock/gmock.h>

#include <atomic>
#include <filesystem>
#include <vector>

#include "core/film/layout.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

TEST(FilmRoom, AJobSaysThatItWaitsForMemoryForItsFilm) {
  FarmWorld world;
  const uint64_t film =
      core::film_memory(core::make_film_layout({}), {0, 0, FarmWorld::kWidth, FarmWorld::kHeight});
  world.options.film_memory = film + film / 2;
  world.start();
  const uint64_t first = world.submit(1);
  const uint64_t second = world.submit(1);
  // Nothing of the first job is delivered before the second has said why it waits.
  std::atomic<bool> go{false};
  ScriptedWorker::Script script = world.script();
  script.threads = 8;
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit&) {
    return eventually([&] { return go.load(); });
  };
  ScriptedWorker worker(world.address, script);
  EXPECT_TRUE(eventually([&] {
    return world.explain(second).find("waits for memory for its film") != std::string::npos;
  })) << world.explain(second);
  EXPECT_EQ(world.explain(first).find("memory"), std::string::npos);
  EXPECT_EQ(world.get(second).job().leased(), 0U);
  go = true;
  EXPECT_TRUE(world.wait_for(first, v1::JOB_STATE_DONE));
  EXPECT_TRUE(world.wait_for(second, v1::JOB_STATE_DONE));
  world.expect_truth(second, 1);
}

std::string aside(const FarmWorld& world, uint64_t job) {
  return world.options.folder + "/films/" + std::to_string(job) + "/1.aside";
}

/// A worker that delivers two units and then takes what it gets.
void begin(FarmWorld& world, uint64_t job) {
  std::atomic<int> delivered{0};
  ScriptedWorker::Script script = world.script();
  script.threads = 1;
  script.meddle = [&](ScriptedWorker&, const v1::LeasedUnit&) { return delivered++ < 2; };
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(eventually([&] { return world.get(job).job().samples_done() > 0; }));
}

/// Until its film is set aside.
void pause(FarmWorld& world, uint64_t job) {
  v1::JobResponse now;
  ASSERT_TRUE(world.jobs->Pause(world.context().get(), about(job), &now).ok());
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(aside(world, job)); }));
}

TEST(FilmRoom, FilmsOfPausedJobsCanBeLookedAt) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  begin(world, job);
  pause(world, job);
  std::string seen;
  const grpc::Status status = fetch_film(world, job, 1, seen);
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_FALSE(seen.empty());
  EXPECT_TRUE(std::filesystem::exists(aside(world, job)));
}

// Who began a large frame and paused the job, again and again, filled all memory; and at each start
// it was filled again.
TEST(FilmRoom, FilmsOfPausedJobsLieOnTheDisk) {
  FarmWorld world;
  const uint64_t film =
      core::film_memory(core::make_film_layout({}), {0, 0, FarmWorld::kWidth, FarmWorld::kHeight});
  world.options.film_memory = film + film / 2;
  world.start();
  std::vector<uint64_t> paused;
  for (int i = 0; i < 3; ++i) {
    paused.push_back(world.submit(1));
    begin(world, paused.back());
    pause(world, paused.back());
  }
  const uint64_t other = world.submit(1);
  {
    const ScriptedWorker worker(world.address, world.script());
    EXPECT_TRUE(world.wait_for(other, v1::JOB_STATE_DONE)) << world.explain(other);
  }
  world.stop();
  world.start();
  for (const uint64_t job : paused) {
    ASSERT_TRUE(eventually([&] { return world.get(job).job().samples_done() > 0; }));
    // They were not in memory: they stay in the log.
    EXPECT_FALSE(std::filesystem::exists(aside(world, job)));
  }
  const ScriptedWorker worker(world.address, world.script());
  for (const uint64_t job : paused) {
    v1::JobResponse now;
    ASSERT_TRUE(world.jobs->Resume(world.context().get(), about(job), &now).ok());
  }
  for (const uint64_t job : paused) {
    ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE)) << world.explain(job);
    world.expect_truth(job, 1);
    EXPECT_FALSE(std::filesystem::exists(aside(world, job)));
  }
}

}  // namespace
}  // namespace hyades::coordinator
