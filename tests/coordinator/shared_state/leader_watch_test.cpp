#include "coordinator/shared_state/leader_watch.h"

#include <chrono>

#include <gtest/gtest.h>

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

LeaseRow row(uint64_t incarnation, uint64_t renewed) {
  return {incarnation, renewed, "host:1", "", 3000ms};
}

TEST(LeaderWatch, TakesOverFromOneThatIsSilentForTheLeasesTime) {
  LeaderWatch watch;
  const LeaderWatch::TimePoint begin{};
  EXPECT_FALSE(watch.is_gone(row(4, 9), begin));
  EXPECT_FALSE(watch.is_gone(row(4, 9), begin + 2999ms));
  EXPECT_TRUE(watch.is_gone(row(4, 9), begin + 3000ms));
}

TEST(LeaderWatch, ARenewalBeginsTheTimeAnew) {
  LeaderWatch watch;
  const LeaderWatch::TimePoint begin{};
  EXPECT_FALSE(watch.is_gone(row(4, 9), begin));
  EXPECT_FALSE(watch.is_gone(row(4, 10), begin + 2900ms));
  EXPECT_FALSE(watch.is_gone(row(4, 10), begin + 5800ms));
  // Of a database that has failed over: the last renewals are lost, and the leader is there.
  EXPECT_FALSE(watch.is_gone(row(4, 8), begin + 8000ms));
  EXPECT_TRUE(watch.is_gone(row(4, 8), begin + 11000ms));
}

TEST(LeaderWatch, ANewLeaderHasItsWholeTime) {
  LeaderWatch watch;
  const LeaderWatch::TimePoint begin{};
  EXPECT_FALSE(watch.is_gone(row(4, 0), begin));
  EXPECT_FALSE(watch.is_gone(row(5, 0), begin + 2900ms));
  EXPECT_FALSE(watch.is_gone(row(5, 0), begin + 5800ms));
}

TEST(LeaderWatch, OneThatHasSteppedDownIsGoneAtOnce) {
  LeaderWatch watch;
  LeaseRow down = row(4, 9);
  down.holder.clear();
  EXPECT_TRUE(watch.is_gone(down, {}));
}

TEST(LeaderWatch, TheLeaderSaysHowLongItsLeaseIs) {
  LeaderWatch watch;
  LeaseRow patient = row(4, 9);
  patient.time = 60s;
  EXPECT_FALSE(watch.is_gone(patient, {}));
  EXPECT_FALSE(watch.is_gone(patient, LeaderWatch::TimePoint{} + 59s));
}

}  // namespace
}  // namespace hyades::coordinator
