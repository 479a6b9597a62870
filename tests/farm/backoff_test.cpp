#include "farm/backoff.h"

#include <gtest/gtest.h>

namespace hyades::farm {
namespace {

using std::chrono::milliseconds;

TEST(Backoff, GrowsAndWaitsAsLongAsItIsAsked) {
  Backoff backoff(milliseconds(200), milliseconds(1000));
  for (const int whole : {200, 400, 800, 1000, 1000}) {
    const auto wait = backoff.next();
    EXPECT_GE(wait, milliseconds(whole / 2));
    EXPECT_LE(wait, milliseconds(whole));
  }
  backoff.reset();
  const auto asked = backoff.next(milliseconds(5000));
  EXPECT_GE(asked, milliseconds(5100)) << "a thousand workers that are sent away together";
  EXPECT_LE(asked, milliseconds(5200)) << "do not come back together";
}

TEST(Backoff, EqualSeedsWaitEqually) {
  Backoff one(milliseconds(200), milliseconds(1000), 7);
  Backoff two(milliseconds(200), milliseconds(1000), 7);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(one.next(), two.next());
}

}  // namespace
}  // namespace hyades::farm
