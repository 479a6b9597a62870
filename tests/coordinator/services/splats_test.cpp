// Jobs whose light paths end anywhere on the film.
#include <gmock/gmock.h>

#include <mutex>
#include <optional>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

using testing::HasSubstr;

const core::PixelRect kFrame{0, 0, FarmWorld::kWidth, FarmWorld::kHeight};

/// What the light paths of the batches in `film` bring: a pure function of them.
void splat(core::Film& film) {
  std::vector<core::PixelSplat> splats;
  for (const core::CoverageBox& box : film.coverage().boxes()) {
    for (uint32_t b = box.batches.first; b < box.batches.end(); ++b) {
      for (uint32_t i = 0; i < 5000; ++i) {
        const uint64_t h = core::hash_combine(b, i);
        splats.push_back({static_cast<uint32_t>(h % static_cast<uint64_t>(kFrame.area())),
                          {static_cast<float>(h >> 40U), 1.0F, 0.5F}});
      }
    }
  }
  film.deposit_splats(std::move(splats));
}

class Splats : public testing::Test {
 protected:
  ScriptedWorker::Script script(int number) {
    ScriptedWorker::Script script = world_.script(number);
    script.layout = core::make_film_layout({.splats = true});
    script.corrupt = splat;
    return script;
  }

  uint64_t submit() {
    return world_.submit_text(FarmWorld::document(1) + "integrator: {type: bdpt}\n");
  }

  /// The picture of frame 1 is that of all camera and light paths, to the last bit.
  void expect_truth(uint64_t job) {
    const std::string bytes = world_.fetch(job, "balls.0001.exr");
    const std::string path = world_.folder.file("got.exr");
    FILE* file = std::fopen(path.c_str(), "wb");
    ASSERT_NE(file, nullptr);
    std::fwrite(bytes.data(), 1, bytes.size(), file);
    std::fclose(file);
    const auto got = core::read_image_file(path);
    ASSERT_TRUE(got.ok()) << got.error().message;
    core::Film film = fake_film({1, kFrame, {0, core::batch_count(FarmWorld::kSamples)}},
                                FarmWorld::kSamples, core::make_film_layout({.splats = true}));
    splat(film);
    const core::Image truth = film.normalised();
    for (const char* name : {"R", "G", "B"}) {
      const int a = got->find_channel(name);
      const int b = truth.find_channel(name);
      ASSERT_GE(a, 0);
      for (int y = 0; y < truth.height; ++y) {
        for (int x = 0; x < truth.width; ++x) {
          ASSERT_EQ(got->at(x, y, a), truth.at(x, y, b)) << name << " " << x << " " << y;
        }
      }
    }
  }

  FarmWorld world_;
};

TEST_F(Splats, ArriveWithTheUnitsThatTheyAreOf) {
  world_.start();
  const uint64_t job = submit();
  ScriptedWorker anna(world_.address, script(1));
  ASSERT_TRUE(world_.wait_for(job, v1::JOB_STATE_DONE));
  expect_truth(job);
}

TEST_F(Splats, OfAnOddWorkerTakeTheirFrameWithThem) {
  world_.start();
  std::mutex mutex;
  std::optional<v1::LeasedUnit> disputed;
  ScriptedWorker::Script wrong = script(1);
  wrong.corrupt = [](core::Film& film) {
    splat(film);
    film.deposit_splats({{7, {1e6F, 1.0F, 1.0F}}});
  };
  wrong.meddle = [&](ScriptedWorker&, const v1::LeasedUnit& unit) {
    const std::lock_guard lock(mutex);
    if (disputed) return false;
    disputed = unit;
    return true;
  };
  const uint64_t job = submit();
  {
    ScriptedWorker divergent(world_.address, wrong);
    ASSERT_TRUE(eventually([&] { return divergent.acknowledged() > 0; }));
    ScriptedWorker bert(world_.address, script(2));
    ScriptedWorker cora(world_.address, script(3));
    ASSERT_TRUE(eventually([&] { return bert.streams() > 0 && cora.streams() > 0; }));
    bert.deliver(world_.leased_to(bert, *disputed));
    cora.deliver(world_.leased_to(cora, *disputed));
    ASSERT_TRUE(world_.wait_for(job, v1::JOB_STATE_DONE));
  }
  expect_truth(job);
  EXPECT_EQ(world_.get(job).frames(0).restarts(), 1U);
  const auto lines = world_.controller->store().lines(job, 0, 1000);
  std::string all;
  for (const StoredLine& line : *lines) all += line.text + "\n";
  EXPECT_THAT(all, HasSubstr("is rendered again from its beginning"));
  EXPECT_THAT(all, testing::Not(HasSubstr("tile 0,0 is rendered again")));
}

TEST_F(Splats, OverAnotherRegionAreRefused) {
  world_.start();
  ScriptedWorker::Script wrong = script(1);
  wrong.corrupt = [](core::Film& film) {
    core::Film other(film.layout(), film.window(), {0, 0, 200, 100});
    const std::vector<float> black(static_cast<size_t>(film.window().area()) * 4);
    for (const core::CoverageBox& box : film.coverage().boxes()) {
      for (uint32_t b = box.batches.first; b < box.batches.end(); ++b) {
        other.deposit(box.tile, b, core::samples_in_batch(b, FarmWorld::kSamples), black);
      }
    }
    film = std::move(other);
  };
  const uint64_t job = submit();
  ScriptedWorker anna(world_.address, wrong);
  ASSERT_TRUE(eventually([&] { return !anna.rejections().empty(); }));
  EXPECT_EQ(anna.rejections().front().reason(), v1::Rejected::REASON_MALFORMED);
  EXPECT_EQ(world_.get(job).job().samples_done(), 0U);
}

}  // namespace
}  // namespace hyades::coordinator
