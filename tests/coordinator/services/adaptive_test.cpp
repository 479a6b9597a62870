// Jobs whose tiles stop at a noise, over real gRPC.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <vector>

#include "coordinator/scheduler/tile_grid.h"
#include "core/film/noise.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kMostSamples = 400;
constexpr float kNoise = 0.246F;

std::string noisy_document(int last_frame) {
  std::string text = FarmWorld::document(last_frame);
  const std::string samples = "{samples: 40}";
  return text.replace(text.find(samples), samples.size(), "{samples: 400, noise: 0.246}");
}

/// The film of the frame as its tiles need it; `batches` of each are counted.
core::Film film_of_frame(int32_t frame, std::map<uint32_t, int>& batches) {
  const auto threshold = core::make_noise_threshold({kNoise, 0, 32}, kMostSamples);
  const core::FilmLayout layout = core::make_film_layout({});
  const core::PixelRect region{0, 0, FarmWorld::kWidth, FarmWorld::kHeight};
  core::Film whole(layout, region);
  const TileGrid grid(region, kTile);
  for (uint32_t i = 0; i < grid.size(); ++i) {
    const core::PixelRect tile = grid.tile(i);
    uint32_t count = core::batch_count(kMostSamples);
    for (const uint32_t round : threshold.rounds) {
      if (!core::is_clean(fake_film({frame, tile, {0, round}}, kMostSamples, layout), tile,
                          threshold)) {
        continue;
      }
      count = round;
      break;
    }
    ++batches[count];
    EXPECT_TRUE(whole.merge(fake_film({frame, tile, {0, count}}, kMostSamples, layout)).ok());
  }
  return whole;
}

void expect_what_tiles_need(const FarmWorld& world, uint64_t job, int frames) {
  std::map<uint32_t, int> batches;
  for (int frame = 1; frame <= frames; ++frame) {
    world.expect_picture(job, frame, film_of_frame(frame, batches));
  }
  EXPECT_GE(batches.size(), 2U) << "tiles are to differ, or nothing is shown";
}

ScriptedWorker::Script script_of(const FarmWorld& world, int number) {
  ScriptedWorker::Script script = world.script(number);
  script.samples = kMostSamples;
  script.unit_time = 2ms;
  return script;
}

TEST(Adaptive, WorkersThatComeAndGoGiveTilesWhatTheyNeed) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit_text(noisy_document(4));
  std::vector<std::unique_ptr<ScriptedWorker>> workers;
  for (int i = 0; i < 9; ++i) {
    if (i >= 3) {
      std::this_thread::sleep_for(30ms);
      workers.erase(workers.begin());
    }
    workers.push_back(std::make_unique<ScriptedWorker>(world.address, script_of(world, i)));
  }
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  expect_what_tiles_need(world, job, 4);
}

TEST(Adaptive, WhatIsNotNeededIsNoWork) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit_text(noisy_document(2));
  const ScriptedWorker worker(world.address, script_of(world, 1));
  ASSERT_TRUE(eventually([&] { return world.get(job).frames(0).state() == v1::FRAME_STATE_DONE; }));
  const v1::Frame frame = world.get(job).frames(0);
  EXPECT_EQ(frame.samples(), frame.samples_done());
  EXPECT_LT(frame.samples(), uint64_t{FarmWorld::kWidth} * FarmWorld::kHeight * kMostSamples / 2);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
}

TEST(Adaptive, TheFarmTellsHowNoisyAFrameIs) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit_text(noisy_document(2));
  EXPECT_FALSE(world.get(job).job().has_noise()) << "nothing is there yet";
  ScriptedWorker::Script script = script_of(world, 1);
  // What it renders of the second frame the worker keeps.
  script.meddle = [](ScriptedWorker&, const v1::LeasedUnit& leased) {
    return leased.unit().frame() == 1;
  };
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(eventually([&] { return world.get(job).frames(0).state() == v1::FRAME_STATE_DONE; }));
  const v1::GetJobResponse now = world.get(job);
  EXPECT_EQ(now.job().noise_aim(), 0.246);
  std::map<uint32_t, int> batches;
  const double truth = core::picture_noise(film_of_frame(1, batches), 0);
  EXPECT_GT(truth, 0.02);
  EXPECT_EQ(now.frames(0).noise(), truth);
  EXPECT_TRUE(now.job().has_noise());
  EXPECT_FALSE(now.frames(1).has_noise()) << "nothing of it is there";
}

TEST(Adaptive, ExplainTellsOfTilesThatAreTooNoisy) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit_text(noisy_document(1));
  ScriptedWorker::Script script = script_of(world, 1);
  // Each tile's first round is delivered, what comes after that is kept.
  script.meddle = [](ScriptedWorker&, const v1::LeasedUnit& leased) {
    return leased.unit().first_batch() < 2;
  };
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(eventually([&] { return world.get(job).job().has_noise(); }));
  EXPECT_THAT(world.explain(job), testing::HasSubstr("frame 1 has a noise of"));
  EXPECT_THAT(world.explain(job), testing::HasSubstr("until the noisiest part of each has 0.25"));
}

TEST(Adaptive, ARestartedCoordinatorDecidesAsTheFirst) {
  FarmWorld world;
  world.options.unit_time = 1ms;  // a batch: so there are many units
  world.start();
  const uint64_t job = world.submit_text(noisy_document(3));
  ScriptedWorker::Script script = script_of(world, 1);
  script.unit_time = 4ms;
  const ScriptedWorker worker(world.address, script);
  for (int life = 0; life < 3; ++life) {
    const uint64_t before = worker.acknowledged();
    ASSERT_TRUE(eventually([&] { return worker.acknowledged() >= before + 13; }));
    world.stop();
    world.start();
  }
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  expect_what_tiles_need(world, job, 3);
}

}  // namespace
}  // namespace hyades::coordinator
