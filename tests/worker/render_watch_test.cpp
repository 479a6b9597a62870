#include "worker/render_watch.h"

#include <gtest/gtest.h>

namespace hyades::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A watch with a limit of 10 s, a child that is ready, and time that passes in ticks.
struct World {
  explicit World(seconds limit = seconds(10)) : watch(limit) {
    watch.tick(now);
    watch.child_started();
    watch.heard();
  }
  /// The child says every half second that it is there; the first hang of that time.
  std::optional<RenderWatch::Hang> pass(milliseconds time, bool alive = true) {
    for (milliseconds past{0}; past < time; past += milliseconds(500)) {
      now += milliseconds(500);
      if (alive) watch.heard();
      if (auto hang = watch.tick(now)) return hang;
    }
    return std::nullopt;
  }
  RenderWatch watch;
  RenderWatch::TimePoint now{std::chrono::hours(1)};
};

TEST(RenderWatch, NamesTheUnitThatGetsNoSampleDoneAndNoOther) {
  World world;
  for (const uint64_t token : {1, 2, 3}) world.watch.told(token, 7);
  world.watch.rendering(1);
  world.watch.rendering(2);
  for (uint64_t i = 1; i < 20; ++i) {
    world.watch.progress(2, 16 * i);
    ASSERT_FALSE(world.pass(milliseconds(500)));
  }
  const auto hang = world.pass(seconds(1));
  ASSERT_TRUE(hang);
  EXPECT_EQ(hang->tokens, std::set<uint64_t>{1});
  EXPECT_EQ(hang->reason, "had no sample done in 10 s and was killed");
  EXPECT_FALSE(world.pass(seconds(60))) << "said once";
}

TEST(RenderWatch, UnitsOfASlowJobHaveLonger) {
  World world;
  world.watch.told(1, 7);
  world.watch.told(2, 8);
  world.watch.rendering(1);
  ASSERT_FALSE(world.pass(seconds(5)));
  world.watch.progress(1, 16);
  ASSERT_FALSE(world.pass(seconds(99))) << "20 times the 5 s that its samples took";
  const auto hang = world.pass(seconds(2));
  ASSERT_TRUE(hang);
  EXPECT_EQ(hang->tokens, std::set<uint64_t>{1});
}

TEST(RenderWatch, LoadingASceneIsNoHangUntilMuchLater) {
  World world;
  world.watch.told(1, 7);
  world.watch.told(2, 7);
  world.watch.loading(1);
  ASSERT_FALSE(world.pass(seconds(299)));
  const auto hang = world.pass(seconds(2));
  ASSERT_TRUE(hang);
  EXPECT_EQ(hang->tokens, std::set<uint64_t>{1});
  EXPECT_NE(hang->reason.find("loading"), std::string::npos);
}

TEST(RenderWatch, AChildThatSaysNothingHangsAlsoWhereItLoads) {
  World world;
  world.watch.told(1, 7);
  world.watch.told(2, 7);
  world.watch.loading(1);
  ASSERT_FALSE(world.pass(milliseconds(9500), false));
  const auto hang = world.pass(seconds(1), false);
  ASSERT_TRUE(hang);
  EXPECT_EQ(hang->tokens, std::set<uint64_t>{1}) << "what waits is not to blame";
  EXPECT_NE(hang->reason.find("no sign of life"), std::string::npos);
}

TEST(RenderWatch, AnIdleChildMayBeSilent) {
  World world;
  world.watch.told(1, 7);
  world.watch.rendering(1);
  world.watch.answered(1);
  EXPECT_FALSE(world.pass(seconds(1000), false));
  world.watch.told(2, 7);
  EXPECT_FALSE(world.pass(seconds(9), false));
}

TEST(RenderWatch, AChildThatNeverGetsReadyHangs) {
  World world;
  world.watch.child_started();
  ASSERT_FALSE(world.pass(milliseconds(9500), false));
  const auto hang = world.pass(seconds(1), false);
  ASSERT_TRUE(hang);
  EXPECT_TRUE(hang->tokens.empty());
}

TEST(RenderWatch, UnitsThatNobodyBeginsAreNotToBlame) {
  World world;
  world.watch.told(1, 7);
  ASSERT_FALSE(world.pass(seconds(299)));
  const auto hang = world.pass(seconds(2));
  ASSERT_TRUE(hang);
  EXPECT_TRUE(hang->tokens.empty());
}

TEST(RenderWatch, TimeInWhichThisProcessDidNotRunDoesNotCount) {
  World world;
  world.watch.told(1, 7);
  world.watch.rendering(1);
  world.now += std::chrono::hours(8);
  EXPECT_FALSE(world.watch.tick(world.now));
  EXPECT_FALSE(world.pass(seconds(8)));
  EXPECT_TRUE(world.pass(seconds(2)));
}

TEST(RenderWatch, WithoutALimitItNeverBites) {
  World world(seconds(0));
  world.watch.told(1, 7);
  world.watch.rendering(1);
  EXPECT_FALSE(world.pass(seconds(10'000), false));
}

}  // namespace
}  // namespace hyades::worker
