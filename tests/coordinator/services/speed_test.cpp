// How fast samples come in, by what was noted of them.
#include <gtest/gtest.h>

#include <chrono>

#include "coordinator/controller/active_job.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

/// A thousand samples a second come in, a lump of them every two seconds.
class Coming {
 public:
  void go_on(int seconds, bool busy = true) {
    for (int i = 0; i < 5 * seconds; ++i) {
      now_ += 200ms;
      if (busy && ++ticks_ % 10 == 0) done_ += 2000;
      speed_.note(done_, now_, busy);
    }
  }
  Speed& speed() { return speed_; }
  void add(uint64_t samples) { done_ += samples; }

 private:
  Speed speed_;
  uint64_t done_ = 0;
  int ticks_ = 0;
  TimePoint now_ = TimePoint{} + 1h;
};

TEST(Speed, OfTheFirstFilmsCountsTheTimeThatTheyTook) {
  Coming coming;
  coming.go_on(1);
  EXPECT_EQ(coming.speed().per_second(), 0) << "nothing is known yet";
  coming.go_on(1);
  EXPECT_NEAR(coming.speed().per_second(), 1000, 250);
  coming.go_on(60);
  EXPECT_NEAR(coming.speed().per_second(), 1000, 150);
}

TEST(Speed, OfTheFirstSecondsTellsNothingOfTheRest) {
  Coming coming;
  coming.go_on(4);
  EXPECT_FALSE(coming.speed().tells_rest());
  coming.go_on(60, false);
  EXPECT_FALSE(coming.speed().tells_rest()) << "nobody has rendered any more of it";
  coming.go_on(4);
  EXPECT_TRUE(coming.speed().tells_rest()) << "that were four lumps in eight seconds";
}

TEST(Speed, IsWhatItWasAfterAPause) {
  Coming coming;
  coming.go_on(30);
  coming.go_on(120, false);
  EXPECT_NEAR(coming.speed().per_second(), 1000, 150);
  coming.go_on(4);
  EXPECT_NEAR(coming.speed().per_second(), 1000, 150);
}

TEST(Speed, DoesNotCountWhatWasRenderedBeforeAStart) {
  Coming coming;
  coming.go_on(2);
  coming.add(1'000'000);
  coming.speed().skip(1'000'000);
  coming.go_on(2);
  EXPECT_NEAR(coming.speed().per_second(), 1000, 150);
}

}  // namespace
}  // namespace hyades::coordinator
