#include "core/textures/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/hash.h"
#include "tests/support/means.h"
#include "tests/support/moments.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

Vec3 random3(test::Random& random, float extent) {
  const float x = random.uniform(-extent, extent);
  const float y = random.uniform(-extent, extent);
  return {x, y, random.uniform(-extent, extent)};
}

Vec4 random4(test::Random& random, float extent) {
  return {random3(random, extent), random.uniform(-extent, extent)};
}

double fade(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

/// Variance of Perlin noise at place p of a cell when every corner draws its gradient anew from
/// vectors with one zero component of `dims` and others +-1: sum over corners of
/// w^2 |d|^2 (dims - 1) / dims; averaged over the cell (midpoints).
double cell_variance(int dims, double scale) {
  const int grid = dims == 3 ? 24 : 12;
  int64_t places = 1;
  for (int d = 0; d < dims; ++d) places *= grid;
  double total = 0.0;
  for (int64_t i = 0; i < places; ++i) {
    double t[4];
    int64_t rest = i;
    for (int d = 0; d < dims; ++d, rest /= grid)
      t[d] = (static_cast<double>(rest % grid) + 0.5) / grid;
    for (int corner = 0; corner < 1 << dims; ++corner) {
      double weight = 1.0;
      double distance2 = 0.0;
      for (int d = 0; d < dims; ++d) {
        const int bit = corner >> d & 1;
        weight *= bit != 0 ? fade(t[d]) : 1.0 - fade(t[d]);
        distance2 += (t[d] - bit) * (t[d] - bit);
      }
      total += weight * weight * distance2 * (dims - 1) / dims;
    }
  }
  return scale * scale * total / static_cast<double>(places);
}

constexpr double kScale3 = 1.0 / 1.0363538;  // see noise.cpp
constexpr double kScale4 = 1.0 / 1.5365823;

TEST(Perlin, IsZeroOnTheLattice) {
  for (int x = -3; x < 4; ++x) {
    for (int y = -3; y < 4; ++y) {
      for (int z = -3; z < 4; ++z) {
        EXPECT_EQ(perlin(Vec3(x, y, z)).value, 0.0F);
        EXPECT_EQ(perlin(Vec4(x, y, z, x + y)).value, 0.0F);
        const Vec3 g = perlin(Vec3(x, y, z)).gradient;  // that of the corner: an edge of a cube
        EXPECT_NEAR(glm::dot(g, g), 2.0 * kScale3 * kScale3, 1e-5);
        const Vec4 g4 = perlin(Vec4(x, y, z, x + y)).gradient;
        EXPECT_NEAR(glm::dot(g4, g4), 3.0 * kScale4 * kScale4, 1e-5);
      }
    }
  }
}

TEST(Perlin, GradientIsTheDerivative) {
  test::Random random(1);
  const double h = 0x1p-7;  // exact in float; fourth-order differences leave about 3e-5
  for (int i = 0; i < 3000; ++i) {
    // Places on a grid of 2^-11, so that p +- h are exact.
    const Vec4 p = glm::floor(random4(random, 40.0F) * 2048.0F) / 2048.0F;
    const Noise3 n3 = perlin(Vec3(p));
    const Noise4 n4 = perlin(p);
    for (int d = 0; d < 4; ++d) {
      // Differences across a lattice plane see the jump of the third derivative.
      const float place = p[d] - std::floor(p[d]);
      if (place < 0.02F || place > 0.98F) continue;
      Vec4 step(0.0F);
      step[d] = static_cast<float>(h);
      const auto f3 = [&](float k) { return double{perlin(Vec3(p + k * step)).value}; };
      const auto f4 = [&](float k) { return double{perlin(p + k * step).value}; };
      const auto slope = [&](const auto& f) {
        return (8.0 * (f(1.0F) - f(-1.0F)) - (f(2.0F) - f(-2.0F))) / (12.0 * h);
      };
      EXPECT_NEAR(n4.gradient[d], slope(f4), 2e-4);
      if (d == 3) continue;
      EXPECT_NEAR(n3.gradient[d], slope(f3), 2e-4);
    }
  }
}

TEST(Perlin, ValueAndGradientAreContinuousAcrossCells) {
  test::Random random(2);
  for (int i = 0; i < 5000; ++i) {
    Vec4 p = random4(random, 20.0F);
    const int d = i % 4;
    p[d] = std::floor(p[d]);
    Vec4 q = p;
    q[d] = std::nextafter(p[d], -100.0F);
    EXPECT_NEAR(perlin(p).value, perlin(q).value, 1e-5F);
    EXPECT_LT(glm::length(perlin(p).gradient - perlin(q).gradient), 1e-4F);
    EXPECT_NEAR(perlin(Vec3(p)).value, perlin(Vec3(q)).value, 1e-5F);
    EXPECT_LT(glm::length(perlin(Vec3(p)).gradient - perlin(Vec3(q)).gradient), 1e-4F);
  }
}

TEST(Perlin, StaysWithinOne) {
  test::Random random(3);
  float high3 = 0.0F;
  float high4 = 0.0F;
  for (int i = 0; i < 1'000'000; ++i) {
    const Vec4 p = random4(random, 1000.0F);
    high3 = std::max(high3, std::fabs(perlin(Vec3(p)).value));
    high4 = std::max(high4, std::fabs(perlin(p).value));
  }
  EXPECT_LE(high3, 1.0F);
  EXPECT_LE(high4, 1.0F);
  EXPECT_GT(high3, 0.75F);  // the range is used
  EXPECT_GT(high4, 0.6F);
}

// The variance is known in closed form, so both moments are tests with a stated power: an error of
// 1 % of the variance, or a mean of 1 % of the standard deviation, would be noticed with 99 %.
TEST(Perlin, MeanIsZeroAndVarianceIsThatOfItsGradients) {
  const test::Promise promise{.tests = 4};
  const double variance3 = cell_variance(3, kScale3);
  const double variance4 = cell_variance(4, kScale4);
  test::Moments mean3;
  test::Moments mean4;
  test::Moments square3;
  test::Moments square4;
  test::Random random(4);
  for (int i = 0; i < 1'000'000; ++i) {
    const Vec4 p = random4(random, 30000.0F);
    const double a = perlin(Vec3(p)).value;
    const double b = perlin(p).value;
    mean3.add(a + std::sqrt(variance3));  // relative errors need a mean that is not 0
    mean4.add(b + std::sqrt(variance4));
    square3.add(a * a);
    square4.add(b * b);
  }
  EXPECT_TRUE(test::mean_is(mean3, std::sqrt(variance3), promise));
  EXPECT_TRUE(test::mean_is(mean4, std::sqrt(variance4), promise));
  EXPECT_TRUE(test::mean_is(square3, variance3, promise));
  EXPECT_TRUE(test::mean_is(square4, variance4, promise));
}

// Gradients have no preferred axis: equal variances, no covariance.
TEST(Perlin, IsIsotropicInItsMoments) {
  double second[4][4] = {};
  constexpr int kCount = 400'000;
  test::Random random(5);
  for (int i = 0; i < kCount; ++i) {
    const Vec4 g = perlin(random4(random, 30000.0F)).gradient;
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) second[a][b] += double{g[a]} * g[b] / kCount;
    }
  }
  const double mean = (second[0][0] + second[1][1] + second[2][2] + second[3][3]) / 4;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      EXPECT_NEAR(second[a][b] / mean, a == b ? 1.0 : 0.0, 0.02) << a << b;
    }
  }
}

// Neighbouring cells, and cells far apart along any small lattice vector, share nothing.
TEST(Perlin, DoesNotRepeat) {
  test::Random random(6);
  const Vec3 shifts[] = {{1, 0, 0},   {0, 1, 0},     {0, 0, 1},     {1, 1, 1},  {256, 0, 0},
                         {0, 256, 0}, {0, 0, 65536}, {65536, 0, 0}, {-1, 2, 5}, {1024, 512, 256}};
  for (const Vec3& shift : shifts) {
    double product = 0.0;
    double square = 0.0;
    for (int i = 0; i < 20'000; ++i) {
      const Vec3 p = glm::floor(random3(random, 100.0F) * 64.0F) / 64.0F;
      const double a = perlin(p).value;
      const double b = perlin(p + shift).value;
      product += a * b;
      square += a * a;
    }
    // Within one cell's distance the noise is correlated by construction (neighbours share
    // corners).
    const double bound = glm::length(shift) < 2.0F ? 0.5 : 0.05;
    EXPECT_LT(std::fabs(product / square), bound) << shift.x << " " << shift.y << " " << shift.z;
  }
}

TEST(Perlin, LargeAndOddCoordinatesAreFinite) {
  test::Random random(7);
  double square = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const double v = perlin(random3(random, 1.0F) * 4.0e6F).value;  // cells of two floats and more
    square += v * v / 20'000;
  }
  EXPECT_NEAR(square, cell_variance(3, kScale3), 0.5 * cell_variance(3, kScale3));
  for (const float x :
       {1e6F, -1e6F, 1e9F, 1e15F, 4e18F, 1e20F, 3e38F, -3e38F,
        std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    for (const Vec4& p : {Vec4(x, 0.5F, 0.5F, 0.5F), Vec4(0.5F, x, x, 0.3F), Vec4(x)}) {
      EXPECT_LE(std::fabs(perlin(Vec3(p)).value), 1.0F) << x;
      EXPECT_LE(std::fabs(perlin(p).value), 1.0F) << x;
      EXPECT_TRUE(std::isfinite(glm::dot(perlin(p).gradient, perlin(p).gradient)));
    }
  }
}

// The fourth coordinate is time: frames close together differ by the time derivative, frames a unit
// apart are new.
TEST(Perlin, FourthDimensionAnimatesSmoothly) {
  test::Random random(8);
  double near = 0.0;
  double far = 0.0;
  double variance = 0.0;
  for (int i = 0; i < 50'000; ++i) {
    Vec4 p = random4(random, 50.0F);
    const Noise4 now = perlin(p);
    p.w += 0.02F;
    const float soon = perlin(p).value;
    EXPECT_NEAR(soon, now.value + 0.02F * now.gradient.w, 0.02F * 0.02F * 8.0F);
    p.w += 2.0F;
    const float later = perlin(p).value;
    near += (soon - now.value) * (soon - now.value) / 50'000;
    far += (later - now.value) * (later - now.value) / 50'000;
    variance += now.value * now.value / 50'000;
  }
  EXPECT_LT(near, 0.01 * variance);
  EXPECT_NEAR(far, 2.0 * variance, 0.1 * variance);
}

TEST(Fbm, OneOctaveIsPerlin) {
  test::Random random(9);
  for (int i = 0; i < 100; ++i) {
    const Vec4 p = random4(random, 10.0F);
    EXPECT_EQ(fbm(p, 1, 2.0F, 0.5F).value, perlin(p).value);
    EXPECT_EQ(fbm(p, 1, 2.0F, 0.5F).gradient, perlin(p).gradient);
    EXPECT_EQ(fbm(Vec3(p), 1, 2.0F, 0.5F).value, perlin(Vec3(p)).value);
    EXPECT_EQ(fbm(Vec3(p), 0, 2.0F, 0.5F).value, perlin(Vec3(p)).value);
  }
}

TEST(Fbm, GradientIsTheDerivative) {
  test::Random random(10);
  const float h = 0x1p-9F;
  for (int i = 0; i < 1000; ++i) {
    const Vec4 p = glm::floor(random4(random, 4.0F) * 4096.0F) / 4096.0F;
    const Noise3 n3 = fbm(Vec3(p), 3, 2.0F, 0.5F);
    const Noise4 n4 = fbm(p, 3, 2.0F, 0.5F);
    for (int d = 0; d < 4; ++d) {
      Vec4 step(0.0F);
      step[d] = h;
      const float slope4 =
          (fbm(p + step, 3, 2.0F, 0.5F).value - fbm(p - step, 3, 2.0F, 0.5F).value) / (2.0F * h);
      EXPECT_NEAR(n4.gradient[d], slope4, 4e-3F);
      if (d == 3) continue;
      const float slope3 =
          (fbm(Vec3(p + step), 3, 2.0F, 0.5F).value - fbm(Vec3(p - step), 3, 2.0F, 0.5F).value) /
          (2.0F * h);
      EXPECT_NEAR(n3.gradient[d], slope3, 4e-3F);
    }
  }
}

// Octaves are independent, so their variances add: sum gain^2i / (sum gain^i)^2 of one octave's.
TEST(Fbm, VarianceIsThatOfIndependentOctaves) {
  const double one = cell_variance(3, kScale3);
  test::Moments square;
  float high = 0.0F;
  test::Random random(11);
  for (int i = 0; i < 600'000; ++i) {
    const float v = fbm(random3(random, 3000.0F), 4, 2.0F, 0.5F).value;
    square.add(double{v} * v);
    high = std::max(high, std::fabs(v));
  }
  const double expected = one * (1.0 + 0.25 + 0.0625 + 0.015625) / (1.875 * 1.875);
  EXPECT_TRUE(test::mean_is(square, expected));
  EXPECT_LE(high, 1.0F);
}

TEST(Fbm, OctavesDoNotMeetAtTheOrigin) {
  EXPECT_NE(fbm(Vec3(0.0F), 3, 2.0F, 0.5F).value, 0.0F);
  EXPECT_NE(fbm(Vec4(0.0F), 3, 2.0F, 0.5F).value, 0.0F);
}

// The constants are the bits that every machine must reproduce (invariant 1).
TEST(Perlin, BitsAreTheSameOnEveryMachine) {
  test::Random random(12);
  uint64_t hash = 0;
  const auto add = [&](float x) { hash = hash_combine(hash, std::bit_cast<uint32_t>(x)); };
  for (int i = 0; i < 100'000; ++i) {
    const Vec4 p = random4(random, 100.0F);
    const Noise3 a = fbm(Vec3(p), 2, 2.1F, 0.4F);
    const Noise4 b = fbm(p, 2, 2.1F, 0.4F);
    add(a.value);
    add(b.value);
    for (int d = 0; d < 3; ++d) add(a.gradient[d]);
    for (int d = 0; d < 4; ++d) add(b.gradient[d]);
  }
  EXPECT_EQ(hash, 0xA5977A26852F8125ULL);
}

}  // namespace
}  // namespace hyades::core
