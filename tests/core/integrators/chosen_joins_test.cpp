#include "core/integrators/chosen_joins.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

namespace hyades::core {
namespace {

using Pair = std::pair<int, int>;

TEST(ChosenJoins, AreAllOfShortSubpaths) {
  for (const float u : {0.0F, 0.4F, 0.999F}) {
    std::map<Pair, float> visited;
    for_chosen_joins(20, 12, 26, u, [&](int s, int t, float weight) {
      EXPECT_EQ(visited.count({s, t}), 0U);
      visited[{s, t}] = weight;
    });
    size_t expected = 0;
    for (int t = 2; t <= 12; ++t) {
      for (int s = 2; s <= 20 && s + t <= 26; ++s, ++expected) {
        EXPECT_EQ((visited[{s, t}]), 1.0F) << s << ", " << t;
      }
    }
    EXPECT_EQ(visited.size(), expected);
  }
}

TEST(ChosenJoins, VisitEachPairInProportionToOneOverItsWeight) {
  constexpr int kSteps = 20'000;
  std::map<Pair, double> sums;
  int most_visits = 0;
  for (int i = 0; i < kSteps; ++i) {
    int visits = 0;
    for_chosen_joins(
        90, 70, 120, (static_cast<float>(i) + 0.5F) / kSteps, [&](int s, int t, float weight) {
          sums[{s, t}] += weight;
          ++visits;
          EXPECT_EQ(weight == 1.0F, s <= ChosenJoins::kFirst && t <= ChosenJoins::kFirst);
        });
    most_visits = std::max(most_visits, visits);
  }
  EXPECT_LE(most_visits, 15 * 15 + ChosenJoins::kLater + 1);
  for (int t = 2; t <= 70; ++t) {
    for (int s = 2; s <= 90 && s + t <= 120; ++s) {
      EXPECT_NEAR((sums[{s, t}] / kSteps), 1.0, 0.01) << s << ", " << t;
      sums.erase({s, t});
    }
  }
  EXPECT_TRUE(sums.empty());
}

TEST(ChosenJoins, OfSubpathsThatDoNotReachThatFarAreNone) {
  for_chosen_joins(1, 90, 200, 0.5F, [](int, int, float) { FAIL(); });
  for_chosen_joins(90, 1, 200, 0.5F, [](int, int, float) { FAIL(); });
  for_chosen_joins(90, 90, 3, 0.5F, [](int, int, float) { FAIL(); });
}

}  // namespace
}  // namespace hyades::core
