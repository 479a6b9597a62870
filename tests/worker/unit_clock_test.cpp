#include "worker/unit_clock.h"

#include <gtest/gtest.h>

namespace hyades::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A clock with a hang limit of 10 s, a child that is ready, and time that passes in ticks.
struct World {
  explicit World(seconds limit = seconds(10), seconds unit_limit = seconds(0))
      : clock(limit, unit_limit) {
    clock.tick(now);
    clock.child_started();
    clock.heard();
  }
  /// The child says every half second that it is there; the first hang of that time.
  std::optional<UnitClock::Hang> pass(milliseconds time, bool alive = true) {
    for (milliseconds past{0}; past < time; past += milliseconds(500)) {
      now += milliseconds(500);
      if (alive) clock.heard();
      clock.tick(now);
      if (auto hang = clock.hang()) return hang;
    }
    return std::nullopt;
  }
  UnitClock clock;
  UnitClock::TimePoint now{std::chrono::hours(1)};
};

TEST(UnitClock, NamesTheUnitThatGetsNoSampleDoneAndNoOther) {
  World world;
  for (const uint64_t token : {1, 2, 3}) world.clock.given(token, 7);
  world.clock.begun(1, false);
  world.clock.begun(2, false);
  for (uint64_t i = 1; i < 20; ++i) {
    world.clock.progress(2, 16 * i);
    ASSERT_FALSE(world.pass(milliseconds(500)));
  }
  const auto hang = world.pass(seconds(1));
  ASSERT_TRUE(hang);
  EXPECT_EQ(hang->tokens, std::set<uint64_t>{1});
  EXPECT_EQ(hang->reason, "had no sample done in 10 s and was killed");
  EXPECT_FALSE(world.pass(seconds(60))) << "said once";
}

TEST(UnitClock, UnitsOfASlowJobHaveLonger) {
  World world;
  world.clock.given(1, 7);
  world.clock.given(2, 8);
  world.clock.begun(1, false);
  ASSERT_FALSE(world.pass(seconds(5)));
  world.clock.progress(1, 16);
  ASSERT_FALSE(world.pass(seconds(99))) << "20 times the 5 s that its samples took";
  const auto hang = world.pass(seconds(2));
  ASSERT_TRUE(hang);
  EXPECT_EQ(hang->tokens, std::set<uint64_t>{1});
}

TEST(UnitClock, LoadingASceneIsNoHangUntilMuchLater) {
  World world;
  world.clock.given(1, 7);
  world.clock.given(2, 7);
  world.clock.begun(1, true);
  ASSERT_FALSE(world.pass(seconds(299)));
  const auto hang = world.pass(seconds(2));
  ASSERT_TRUE(hang);
  EXPECT_EQ(hang->tokens, std::set<uint64_t>{1});
  EXPECT_NE(hang->reason.find("loading"), std::string::npos);
}

TEST(UnitClock, AChildThatSaysNothingHangsAlsoWhereItLoads) {
  World world;
  world.clock.given(1, 7);
  world.clock.given(2, 7);
  world.clock.begun(1, true);
  ASSERT_FALSE(world.pass(milliseconds(9500), false));
  const auto hang = world.pass(seconds(1), false);
  ASSERT_TRUE(hang);
  EXPECT_EQ(hang->tokens, std::set<uint64_t>{1}) << "what waits is not to blame";
  EXPECT_NE(hang->reason.find("no sign of life"), std::string::npos);
}

TEST(UnitClock, AnIdleChildMayBeSilent) {
  World world;
  world.clock.given(1, 7);
  world.clock.begun(1, false);
  world.clock.answered(1);
  EXPECT_FALSE(world.pass(seconds(1000), false));
  world.clock.given(2, 7);
  EXPECT_FALSE(world.pass(seconds(9), false));
}

TEST(UnitClock, AChildThatNeverGetsReadyHangs) {
  World world;
  world.clock.child_started();
  ASSERT_FALSE(world.pass(milliseconds(9500), false));
  const auto hang = world.pass(seconds(1), false);
  ASSERT_TRUE(hang);
  EXPECT_TRUE(hang->tokens.empty());
}

TEST(UnitClock, UnitsThatNobodyBeginsAreNotToBlame) {
  World world;
  world.clock.given(1, 7);
  ASSERT_FALSE(world.pass(seconds(299)));
  const auto hang = world.pass(seconds(2));
  ASSERT_TRUE(hang);
  EXPECT_TRUE(hang->tokens.empty());
}

TEST(UnitClock, TimeInWhichThisProcessDidNotRunDoesNotCount) {
  World world;
  world.clock.given(1, 7);
  world.clock.begun(1, false);
  world.now += std::chrono::hours(8);
  world.clock.tick(world.now);
  EXPECT_FALSE(world.clock.hang());
  EXPECT_FALSE(world.pass(seconds(8)));
  EXPECT_TRUE(world.pass(seconds(2)));
}

TEST(UnitClock, WithoutALimitItNeverBites) {
  World world(seconds(0));
  world.clock.given(1, 7);
  world.clock.begun(1, false);
  EXPECT_FALSE(world.pass(seconds(10'000), false));
}

TEST(UnitClock, AUnitsTimeBeginsWithTheLoadingOfItsSceneAndIsToldOnce) {
  World world(seconds(0), seconds(10));
  world.clock.given(1, 7);
  world.pass(seconds(60));
  EXPECT_TRUE(world.clock.overdue().tokens.empty()) << "it waits";
  world.clock.begun(1, true);
  world.pass(seconds(6));
  world.clock.begun(1, false);
  world.pass(seconds(4));
  const UnitClock::Overdue overdue = world.clock.overdue();
  EXPECT_EQ(overdue.tokens, std::vector<uint64_t>{1});
  EXPECT_FALSE(overdue.stuck);
  EXPECT_TRUE(world.clock.overdue().tokens.empty()) << "said once";
  world.pass(UnitClock::kStopping);
  EXPECT_TRUE(world.clock.overdue().stuck) << "it was to stop";
}

}  // namespace
}  // namespace hyades::worker
