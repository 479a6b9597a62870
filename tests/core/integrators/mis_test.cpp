#include "core/integrators/mis.h"

#include <gtest/gtest.h>

namespace hyades::core {
namespace {

TEST(PowerHeuristic, WeightsOfTwoTechniquesAddUpToOne) {
  for (const float a : {1e-30F, 1e-3F, 1.0F, 7.0F, 1e30F}) {
    for (const float b : {1e-30F, 1e-3F, 1.0F, 7.0F, 1e30F}) {
      EXPECT_NEAR(power_heuristic(a, b) + power_heuristic(b, a), 1.0F, 1e-6F) << a << " " << b;
    }
  }
  EXPECT_FLOAT_EQ(power_heuristic(3.0F, 1.0F), 0.9F);
}

TEST(PowerHeuristic, WhatOneTechniqueCannotFindTheOtherCountsFully) {
  EXPECT_EQ(power_heuristic(0.5F, 0.0F), 1.0F);
  EXPECT_EQ(power_heuristic(0.0F, 0.5F), 0.0F);
  EXPECT_EQ(power_heuristic(0.0F, 0.0F), 0.0F);
}

}  // namespace
}  // namespace hyades::core
