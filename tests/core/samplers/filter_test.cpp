#include "core/samplers/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/chi_squared.h"
#include "tests/support/means.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

constexpr double kPiD = 3.14159265358979323846;

/// The filters once more, from their formulas, not normalised; x in units of the radius.
struct Case {
  std::string name;
  FilterShape shape;
  float radius;
  std::function<double(double)> formula;
};

double mitchell_formula(double x) {
  const double b = 1.0 / 3.0;
  const double c = 1.0 / 3.0;
  const double a = 2.0 * std::abs(x);
  if (a < 1.0) {
    return ((12 - 9 * b - 6 * c) * a * a * a + (-18 + 12 * b + 6 * c) * a * a + (6 - 2 * b)) / 6;
  }
  return ((-b - 6 * c) * a * a * a + (6 * b + 30 * c) * a * a + (-12 * b - 48 * c) * a +
          (8 * b + 24 * c)) /
         6;
}

std::vector<Case> cases() {
  return {
      {"box", FilterShape::box, 0.5F, [](double) { return 1.0; }},
      {"triangle", FilterShape::triangle, 1.0F, [](double x) { return 1.0 - std::abs(x); }},
      {"gaussian", FilterShape::gaussian, 1.5F,
       [](double x) { return std::exp(-4.5 * x * x) - std::exp(-4.5); }},
      {"mitchell", FilterShape::mitchell, 2.0F, mitchell_formula},
      {"blackman-harris", FilterShape::blackman_harris, 1.5F,
       [](double x) {
         return 0.35875 + 0.48829 * std::cos(kPiD * x) + 0.14128 * std::cos(2 * kPiD * x) +
                0.01168 * std::cos(3 * kPiD * x);
       }},
  };
}

double normaliser(const Case& c) {
  return c.radius * test::integrate([&](double x) { return c.formula(x); }, -1.0, 1.0);
}

TEST(Filter, EvaluateIsTheFormulaNormalised) {
  for (const Case& c : cases()) {
    const auto filter = make_pixel_filter(c.shape, c.radius);
    const double norm = normaliser(c);
    const double peak = c.formula(0.0) * c.formula(0.0) / (norm * norm);
    for (int i = 0; i < 60; ++i) {
      for (int j = 0; j < 60; ++j) {
        const double x = (i - 29.7) / 30.0;
        const double y = (j - 29.2) / 30.0;
        const double expected =
            std::abs(x) < 1 && std::abs(y) < 1 ? c.formula(x) * c.formula(y) / (norm * norm) : 0;
        EXPECT_NEAR(filter->evaluate(c.radius * Vec2(x, y)), expected, 2e-5 * peak) << c.name;
      }
    }
    EXPECT_EQ(filter->evaluate({1.01F * c.radius, 0.0F}), 0.0F);
  }
}

TEST(Filter, IntegratesToOne) {
  for (const Case& c : cases()) {
    const auto filter = make_pixel_filter(c.shape, c.radius);
    double sum = 0.0;
    constexpr int kGrid = 1024;  // midpoints; the filters' own kinks make an error of 1e-6
    const double step = 2.0 * c.radius / kGrid;
    for (int j = 0; j < kGrid; ++j) {
      for (int i = 0; i < kGrid; ++i) {
        sum += filter->evaluate(Vec2(-c.radius + (i + 0.5) * step, -c.radius + (j + 0.5) * step));
      }
    }
    EXPECT_NEAR(sum * step * step, 1.0, 1e-5) << c.name;
  }
}

TEST(Filter, PlacesFollowItsMagnitude) {
  constexpr int kCells = 20;
  const std::vector<Case> all = cases();
  const double alpha = test::sidak(0.01, static_cast<int>(all.size()));
  const int64_t count = test::required_chi_squared_samples(kCells * kCells - 1, 0.02, alpha, 0.99);
  for (const Case& c : all) {
    const auto filter = make_pixel_filter(c.shape, c.radius);
    std::vector<double> share(kCells);  // of |f| in one dimension
    double total = 0.0;
    for (int i = 0; i < kCells; ++i) {
      share[i] = test::integrate([&](double x) { return std::abs(c.formula(x)); },
                                 -1.0 + 2.0 * i / kCells, -1.0 + 2.0 * (i + 1) / kCells);
      total += share[i];
    }
    std::vector<double> expected;
    for (int j = 0; j < kCells; ++j) {
      for (int i = 0; i < kCells; ++i) {
        expected.push_back(static_cast<double>(count) * share[i] * share[j] / (total * total));
      }
    }
    std::vector<double> observed(expected.size());
    test::Random random(11);
    for (int64_t n = 0; n < count; ++n) {
      const Vec2 offset = filter->sample(random.uniform2()).offset;
      ASSERT_LE(std::max(std::abs(offset.x), std::abs(offset.y)), c.radius);
      const auto i = std::min(static_cast<int>((offset.x / c.radius + 1) * 0.5 * kCells), 19);
      const auto j = std::min(static_cast<int>((offset.y / c.radius + 1) * 0.5 * kCells), 19);
      observed[j * kCells + i] += 1.0;
    }
    EXPECT_GT(test::chi_squared(observed, expected).p, alpha) << c.name;
  }
}

TEST(Filter, WeightsAreOneOrOfOneMagnitudeWithTheFiltersSign) {
  for (const Case& c : cases()) {
    const auto filter = make_pixel_filter(c.shape, c.radius);
    const double absolute =
        c.radius *
        test::integrate([&](double x) { return std::abs(c.formula(x)); }, -1.0, 1.0, 1e-10, 64);
    const double ratio = absolute / normaliser(c);
    test::Random random(12);
    for (int n = 0; n < 20'000; ++n) {
      const FilterSample s = filter->sample(random.uniform2());
      const float f = filter->evaluate(s.offset);
      if (c.shape == FilterShape::mitchell) {
        EXPECT_NEAR(std::abs(s.weight), ratio * ratio, 1e-4);
        EXPECT_TRUE(std::abs(f) < 1e-6F || (s.weight < 0.0F) == (f < 0.0F));
      } else {
        EXPECT_EQ(s.weight, 1.0F) << c.name;
      }
    }
  }
}

// The means of 1 and of two functions of the place, weighted, are the integrals under the filter:
// what a picture converges to. Each detects an error of 1 % with 99 % probability (mean_is says).
TEST(Filter, WeightedMeansAreUnbiased) {
  const std::vector<Case> all = cases();
  const test::Promise promise{.tests = 3 * static_cast<int>(all.size())};
  for (const Case& c : all) {
    const auto filter = make_pixel_filter(c.shape, c.radius);
    const double norm = normaliser(c) / c.radius;
    const auto wave = [](double x) { return std::cos(1.5 * x + 0.4); };
    const double wave_mean =
        test::integrate([&](double x) { return c.formula(x) * wave(x); }, -1, 1) / norm;
    const double square_mean =
        test::integrate([&](double x) { return c.formula(x) * (x * x + 0.5); }, -1, 1) / norm;
    test::Moments one;
    test::Moments waves;
    test::Moments squares;
    test::Random random(13);
    for (int n = 0; n < 400'000; ++n) {
      const FilterSample s = filter->sample(random.uniform2());
      const double x = s.offset.x / c.radius;
      const double y = s.offset.y / c.radius;
      one.add(s.weight);
      waves.add(s.weight * wave(x) * wave(y));
      squares.add(s.weight * (x * x + 0.5) * (y * y + 0.5));
    }
    EXPECT_TRUE(test::mean_is(one, 1.0, promise)) << c.name;
    EXPECT_TRUE(test::mean_is(waves, wave_mean * wave_mean, promise)) << c.name;
    EXPECT_TRUE(test::mean_is(squares, square_mean * square_mean, promise)) << c.name;
  }
}

// Inverse distribution functions keep the order of the numbers, and so their stratification.
TEST(Filter, PlacesRiseWithTheNumber) {
  for (const Case& c : cases()) {
    const auto filter = make_pixel_filter(c.shape, c.radius);
    float last = -c.radius;
    for (int i = 0; i < 100'000; ++i) {
      const float u = (static_cast<float>(i) + 0.5F) / 100'000.0F;
      const float x = filter->sample({u, 0.5F}).offset.x;
      ASSERT_GE(x, last - 1e-6F) << c.name << " " << u;
      last = x;
    }
    EXPECT_NEAR(filter->sample({0.5F, 0.5F}).offset.x, 0.0F, 1e-5F);
    EXPECT_EQ(filter->sample({0.0F, 0.0F}).offset, Vec2(-c.radius));
    EXPECT_LE(filter->sample({0x1.fffffep-1F, 0.0F}).offset.x, c.radius);
  }
}

TEST(Filter, CenterPutsEverySampleOnTheCentre) {
  const auto filter = make_pixel_filter(FilterShape::center, 2.0F);
  const FilterSample s = filter->sample({0.1F, 0.9F});
  EXPECT_EQ(s.offset, Vec2(0.0F));
  EXPECT_EQ(s.weight, 1.0F);
  EXPECT_EQ(filter->evaluate({0.0F, 0.0F}), 0.0F);
  EXPECT_EQ(make_pixel_filter(FilterShape::box, 0.0F)->sample({0.1F, 0.9F}).offset, Vec2(0.0F));
}

}  // namespace
}  // namespace hyades::core
