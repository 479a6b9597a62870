#include "core/textures/pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>
#include <string>

#include "tests/support/random.h"

namespace hyades::core {
namespace {

struct Case {
  std::string name;
  PatternPtr pattern;
  double mean = -1.0;        ///< over space; below 0: not known beforehand
  double share_near = 0.97;  ///< of places where differences must agree with the gradient
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const bool timed : {false, true}) {
    const std::string suffix = timed ? "4d" : "3d";
    FractalDesc desc{.octaves = 3, .time = std::nullopt};
    if (timed) desc.time = 0.3F;
    all.push_back({"fbm" + suffix, make_fractal_pattern(FractalKind::fbm, desc), 0.5});
    all.push_back({"turbulence" + suffix, make_fractal_pattern(FractalKind::turbulence, desc)});
    all.push_back({"ridged" + suffix, make_fractal_pattern(FractalKind::ridged, desc)});
    all.push_back({"marble" + suffix, make_marble_pattern(desc, 1.5F), 0.5});
    // Each ring rises over nine tenths of its width and falls over one: half of it on average.
    all.push_back({"wood" + suffix, make_wood_pattern(desc, 0.5F), -1.0});
    for (const CellMetric metric :
         {CellMetric::euclidean, CellMetric::manhattan, CellMetric::chebyshev}) {
      for (const CellFeature feature : {CellFeature::f1, CellFeature::f2, CellFeature::edges}) {
        CellularDesc cells{metric, feature, 1.0F, std::nullopt};
        if (timed) cells.time = 0.3F;
        all.push_back({"cells" + std::to_string(static_cast<int>(metric)) +
                           std::to_string(static_cast<int>(feature)) + suffix,
                       make_cellular_pattern(cells)});
      }
    }
  }
  all.push_back({"cell_id", make_cellular_pattern({.feature = CellFeature::cell_id}), 0.5});
  // What is not mortar is (1 - m)^2 of a brick where edges are hard.
  all.push_back({"brick", make_brick_pattern(0.2F, 0.5F, 0.0F), 1.0 - 0.8 * 0.8});
  all.push_back({"soft_brick", make_brick_pattern(0.2F, 0.3F, 0.5F)});
  all.push_back({"stripes", make_line_pattern(false, 0.25F, 0.0F), 0.25});
  all.push_back({"soft_grid", make_line_pattern(true, 0.25F, 1.0F)});
  for (int shape = 0; shape < 5; ++shape) {
    all.push_back({"gradient" + std::to_string(shape),
                   make_gradient_pattern(static_cast<GradientShape>(shape))});
  }
  return all;
}

class EachPattern : public testing::TestWithParam<Case> {};

Vec3 place(test::Random& random) {
  return {random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-40, 40)};
}

TEST_P(EachPattern, StaysWithinItsRangeAndHasItsMean) {
  test::Random random(11);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const float value = GetParam().pattern->at(place(random)).value;
    ASSERT_GE(value, 0.0F);
    ASSERT_LE(value, 1.0F);
    sum += double{value};
    squares += double{value} * double{value};
  }
  const double mean = sum / kCount;
  const double deviation = std::sqrt(squares / kCount - mean * mean);
  EXPECT_GT(deviation, 1e-3);
  if (GetParam().mean >= 0.0) {
    EXPECT_NEAR(mean, GetParam().mean, 5.0 * deviation / std::sqrt(kCount));
  }
}

TEST_P(EachPattern, GradientIsThatOfDifferences) {
  test::Random random(12);
  int near = 0;
  constexpr int kCount = 600;
  const float h = 0x1p-11F;
  for (int i = 0; i < kCount; ++i) {
    const Vec3 p = 3.0F * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Noise3 n = GetParam().pattern->at(p);
    float error = 0.0F;
    for (int d = 0; d < 3; ++d) {
      Vec3 step(0.0F);
      step[d] = h;
      const float slope =
          (GetParam().pattern->at(p + step).value - GetParam().pattern->at(p - step).value) /
          (2.0F * h);
      error = std::max(error, std::abs(slope - n.gradient[d]));
    }
    near +=
        error < 0.03F * (1.0F + glm::length(n.gradient)) ? 1 : 0;  // but across creases and jumps
  }
  EXPECT_GE(near, GetParam().share_near * kCount);
}

TEST_P(EachPattern, HugeAndBrokenCoordinatesAreHarmless) {
  for (const float x : {1e6F, -1e9F, 1e18F, 3e38F, INFINITY, NAN}) {
    const float value = GetParam().pattern->at({x, x, x}).value;
    EXPECT_TRUE(!(value < 0.0F) && !(value > 1.0F)) << x;
  }
}

INSTANTIATE_TEST_SUITE_P(All, EachPattern, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

// No direction of space is preferred: the means and variances of differences along the axes and
// across them agree.
TEST(FractalPattern, LooksTheSameAlongEveryAxis) {
  for (const FractalKind kind : {FractalKind::turbulence, FractalKind::ridged}) {
    const auto pattern = make_fractal_pattern(kind, {.octaves = 2, .time = std::nullopt});
    test::Random random(13);
    Vec3 squares(0.0F);
    for (int i = 0; i < 40000; ++i) {
      const Vec3 g = pattern->at(place(random)).gradient;
      squares += g * g / 40000.0F;
    }
    EXPECT_NEAR(squares.x / squares.y, 1.0F, 0.05F);
    EXPECT_NEAR(squares.z / squares.y, 1.0F, 0.05F);
  }
}

// |n| and (1 - |n|)^2 of the same noise: the first octave alone says what the other is.
TEST(FractalPattern, RidgesAreTurbulenceTurnedOver) {
  const auto ridged = make_fractal_pattern(FractalKind::ridged, {.time = 0.4F});
  const auto creased = make_fractal_pattern(FractalKind::turbulence, {.time = 0.4F});
  const auto plain = make_fractal_pattern(FractalKind::fbm, {.time = 0.4F});
  test::Random random(14);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = place(random);
    const float n = std::abs(2.0F * plain->at(p).value - 1.0F);
    EXPECT_NEAR(creased->at(p).value, n, 1e-5F);
    EXPECT_NEAR(ridged->at(p).value, (1.0F - n) * (1.0F - n), 1e-5F);
  }
}

TEST(FractalPattern, TimeMovesIt) {
  for (const FractalKind kind : {FractalKind::turbulence, FractalKind::ridged}) {
    const Vec3 p(0.3F, 0.7F, 0.2F);
    const auto at = [&](float t) { return make_fractal_pattern(kind, {.time = t})->at(p).value; };
    EXPECT_NE(at(0.0F), at(0.6F));
    EXPECT_NEAR(at(0.2F), at(0.21F), 0.05F);
  }
}

// Against its gradient lies the point that f1 is the distance to.
TEST(CellularPattern, DistancesArePointsDistances) {
  const auto f1 = make_cellular_pattern({.feature = CellFeature::f1});
  const auto f2 = make_cellular_pattern({.feature = CellFeature::f2});
  const auto edges = make_cellular_pattern({.feature = CellFeature::edges});
  test::Random random(15);
  int followed = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = place(random);
    const Noise3 first = f1->at(p);
    EXPECT_LE(first.value, f2->at(p).value);
    if (f2->at(p).value < 1.0F) {
      EXPECT_FLOAT_EQ(edges->at(p).value, f2->at(p).value - first.value);
    } else {
      EXPECT_GE(edges->at(p).value, 1.0F - first.value);
    }
    if (first.value >= 1.0F) continue;
    // Against the gradient lies the point itself, and there the distance is 0.
    const Vec3 point = p - first.value * first.gradient;
    EXPECT_NEAR(f1->at(point).value, 0.0F, 2e-5F);
    ++followed;
  }
  EXPECT_GT(followed, 1900);
}

// A grid of middles: the distances are known.
TEST(CellularPattern, WithoutJitterItIsALattice) {
  const struct {
    CellMetric metric;
    float expected;
  } kinds[] = {{CellMetric::euclidean, std::sqrt(0.01F + 0.04F + 0.09F)},
               {CellMetric::manhattan, 0.6F},
               {CellMetric::chebyshev, 0.3F}};
  for (const auto& kind : kinds) {
    const auto pattern = make_cellular_pattern({kind.metric, CellFeature::f1, 0.0F, std::nullopt});
    EXPECT_NEAR(pattern->at({7.4F, -2.3F, 0.8F}).value, kind.expected, 1e-5F);
  }
}

TEST(PlanePatterns, LinesAndBricksLieWhereTheySay) {
  const auto brick = make_brick_pattern(0.2F, 0.5F, 0.0F);
  EXPECT_EQ(brick->at({0.5F, 0.5F, 9.0F}).value, 0.0F);
  EXPECT_EQ(brick->at({0.05F, 0.5F, 9.0F}).value, 1.0F);
  EXPECT_EQ(brick->at({0.5F, 0.95F, 9.0F}).value, 1.0F);
  EXPECT_EQ(brick->at({0.05F, 1.5F, 9.0F}).value, 0.0F) << "the next row is moved";
  EXPECT_EQ(brick->at({0.55F, 1.5F, 9.0F}).value, 1.0F);
  EXPECT_EQ(brick->at({0.05F, -0.5F, 9.0F}).value, 0.0F);
  const auto stripes = make_line_pattern(false, 0.5F, 0.0F);
  EXPECT_EQ(stripes->at({0.2F, 0.5F, 0.0F}).value, 1.0F);
  EXPECT_EQ(stripes->at({0.3F, 0.0F, 0.0F}).value, 0.0F);
  EXPECT_EQ(stripes->at({-0.2F, 0.5F, 0.0F}).value, 1.0F);
  EXPECT_EQ(make_line_pattern(true, 0.5F, 0.0F)->at({0.5F, 0.1F, 0.0F}).value, 1.0F);
}

TEST(GradientPattern, GoesFromZeroToOne) {
  const auto value = [](GradientShape shape, const Vec3& p) {
    return make_gradient_pattern(shape)->at(p).value;
  };
  EXPECT_EQ(value(GradientShape::linear, {0.25F, 9, 9}), 0.25F);
  EXPECT_EQ(value(GradientShape::linear, {-1, 9, 9}), 0.0F);
  EXPECT_EQ(value(GradientShape::linear, {2, 9, 9}), 1.0F);
  EXPECT_FLOAT_EQ(value(GradientShape::radial, {0.3F, 0.4F, 9}), 0.5F);
  EXPECT_FLOAT_EQ(value(GradientShape::cylindrical, {0.3F, 9, 0.4F}), 0.5F);
  EXPECT_FLOAT_EQ(value(GradientShape::spherical, {0.2F, 0.4F, 0.4F}), 0.6F);
  EXPECT_FLOAT_EQ(value(GradientShape::angular, {0, 2, 9}), 0.25F);
  EXPECT_FLOAT_EQ(value(GradientShape::angular, {0, -2, 9}), 0.75F);
}

}  // namespace
}  // namespace hyades::core
