// Fields say truly between which values they lie, and walks through their bounds miss nothing.

#include <gtest/gtest.h>

#include <cmath>

#include "core/media/noise_density.h"
#include "core/media/shell_field.h"
#include "core/textures/noise.h"
#include "tests/core/media/volumes.h"

namespace hyades::core {
namespace {

Vec3 within(const Bounds& bounds, test::Random& random) {
  const Vec3 u(random.uniform(), random.uniform(), random.uniform());
  return bounds.lower + u * bounds.size();
}

TEST(BrickGrid, InterpolatesTrilinearlyAcrossBricks) {
  const auto value = [](const Vec3i& p) {
    return static_cast<float>(p.x) + 0.5F * static_cast<float>(p.y) -
           0.25F * static_cast<float>(p.z);
  };
  const BrickGrid<float> grid(Vec3i(-9, 0, 2), Vec3i(20, 17, 30), value);
  test::Random random(1);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = within({Vec3(-9, 0, 2), Vec3(20, 17, 30)}, random);
    EXPECT_NEAR(grid.at(p), p.x + 0.5F * p.y - 0.25F * p.z, 1e-4F);
  }
  EXPECT_EQ(grid.at(Vec3(-10.1F, 3.0F, 5.0F)), 0.0F);
  EXPECT_NEAR(grid.at(Vec3(-9.75F, 3.0F, 5.0F)), 0.25F * value({-9, 3, 5}), 1e-5F);
  EXPECT_EQ(grid.at(Vec3(std::nanf(""), 3.0F, 5.0F)), 0.0F);
}

TEST(BrickGrid, KeepsOnlyBricksThatHoldSomething) {
  const auto value = [](const Vec3i& p) { return p == Vec3i(50, 60, 70) ? 2.0F : 0.0F; };
  const BrickGrid<float> grid(Vec3i(0), Vec3i(127), value);
  EXPECT_LE(grid.brick_count(), 8U);
  EXPECT_EQ(grid.at(Vec3(50.0F, 60.0F, 70.0F)), 2.0F);
  EXPECT_FLOAT_EQ(grid.at(Vec3(50.5F, 60.5F, 69.5F)), 0.25F);
}

TEST(BrickGrid, IsTheSameWhereItIsToldWhichBoxesHoldSomething) {
  // Boxes that begin and end on every place of a brick, on both sides of 0.
  const Vec3i lower(-21, -20, -19);
  const Vec3i upper(60, 25, 24);
  for (int shift = 0; shift < 9; ++shift) {
    const Vec3i first = Vec3i(-20, -11, -3) + shift;
    const Vec3i last = first + 7;
    const auto value = [&](const Vec3i& p) {
      return p == glm::clamp(p, first, last) ? 1.0F + static_cast<float>(p.x & 3) : 0.0F;
    };
    const BrickGrid<float> all(lower, upper, value);
    const BrickGrid<float> told(lower, upper, value,
                                [&](const auto& visit) { visit(first, last); });
    EXPECT_EQ(told.brick_count(), all.brick_count());
    test::Random random(static_cast<uint64_t>(shift));
    const Bounds near{Vec3(first) - 9.0F, Vec3(last) + 9.0F};
    for (int n = 0; n < 500; ++n) {
      const Vec3 p = within(near, random);
      ASSERT_EQ(told.at(p), all.at(p));
    }
  }
}

void expect_bounded(const DensityField& field, uint64_t seed) {
  test::Random random(seed);
  const Bounds all = field.bounds();
  for (int n = 0; n < 400; ++n) {
    Bounds box;
    box.include(within(all, random));
    box.include(box.lower + random.uniform() * random.uniform() * all.size());
    const Extent extent = field.over(box);
    for (int k = 0; k < 40; ++k) {
      const float value = field.at(within(box, random));
      ASSERT_GE(value, extent.least - 1e-6F);
      ASSERT_LE(value, extent.greatest + 1e-6F);
    }
  }
}

TEST(Fields, LieBetweenTheirBounds) {
  expect_bounded(*make_grid_density(random_grid(30, 5)), 2);
  const Bounds body{Vec3(-1.0F, -2.0F, 0.5F), Vec3(2.0F, 1.0F, 2.5F)};
  for (const float fade : {0.0F, 0.6F}) {
    for (const float high : {0.6F, 0.45F, 0.2F}) {
      NoiseDensity noise;
      noise.scale = {1.3F, -0.8F, 1.0F};
      noise.offset = Vec3(3.0F, 0.2F, -7.0F);
      noise.time = 0.37F;
      noise.low = 0.45F;
      noise.high = high;
      noise.fade = fade;
      expect_bounded(*make_noise_density(noise, body), 3);
    }
  }
}

// Where the edge is sharp, `high` does not matter.
TEST(Fields, NoiseStepsAtLowWhereHighIsNotAboveIt) {
  const Bounds body{Vec3(-1.0F), Vec3(1.0F)};
  NoiseDensity noise;
  noise.scale = Vec3(2.3F);
  noise.low = noise.high = 0.55F;
  const auto sharp = make_noise_density(noise, body);
  noise.high = 0.3F;
  const auto turned = make_noise_density(noise, body);
  test::Random random(5);
  int dense = 0;
  for (int n = 0; n < 4000; ++n) {
    const Vec3 p = within(body, random);
    const float fractal = fbm(Vec4(p * noise.scale, 0.0F), 5, 2.0F, 0.5F).value;
    const float expected = 0.5F + 0.5F * fractal > 0.55F ? 1.0F : 0.0F;
    EXPECT_EQ(sharp->at(p), expected);
    EXPECT_EQ(turned->at(p), expected);
    dense += expected > 0.0F ? 1 : 0;
  }
  EXPECT_GT(dense, 400);
  EXPECT_LT(dense, 3600);
}

TEST(Fields, ShellsLieBetweenTheirBounds) {
  auto image = std::make_shared<Image>(make_image(70, 33, {"R", "G", "B"}));
  test::Random random(6);
  for (float& value : image->data) value = random.uniform() < 0.1F ? random.uniform() : 0.0F;
  Shell shell;
  shell.image = image;
  shell.inner = 0.7F;
  shell.low = 0.1F;
  shell.high = 0.5F;
  for (const float swirl : {0.0F, 0.2F}) {
    shell.swirl = swirl;
    expect_bounded(*make_shell(shell).density, 5);
  }
}

// +x is in the middle of the image, -z a quarter to the left of it, +y on top.
TEST(Fields, ShellsWrapTheImageAsAnEnvironmentDoes) {
  auto image = std::make_shared<Image>(make_image(400, 200, {"R", "G", "B"}));
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 400; ++x) {
      image->at(x, y, 0) = static_cast<float>(x) / 400.0F;
      image->at(x, y, 1) = static_cast<float>(y) / 200.0F;
      image->at(x, y, 2) = 1.0F;
    }
  }
  Shell shell;
  shell.image = image;
  shell.high = 0.5F;
  EXPECT_NEAR(luminance(make_shell(shell).glow->at(Vec3(0.9F, 0.0F, 0.0F))), 0.5F, 1e-5F);
  shell.high = 1.0F;
  const ShellFields fields = make_shell(shell);
  const auto glow = [&](const Vec3& direction) { return fields.glow->at(0.9F * direction); };
  EXPECT_NEAR(glow({1.0F, 0.0F, 0.0F}).x, 0.5F, 0.01F);
  EXPECT_NEAR(glow({0.0F, 0.0F, -1.0F}).x, 0.25F, 0.01F);
  EXPECT_NEAR(glow({1.0F, 0.0F, 0.0F}).y, 0.5F, 0.01F);
  EXPECT_NEAR(glow({0.0F, 1.0F, 0.0F}).y, 0.0F, 0.01F);
  EXPECT_NEAR(glow({0.6F, -0.8F, 0.0F}).y, 0.795F, 0.01F);
  EXPECT_NEAR(fields.density->at(Vec3(0.85F, 0.0F, 0.0F)),
              0.75F * (0.2126F * 0.5F + 0.7152F * 0.5F + 0.0722F), 0.01F);
  EXPECT_EQ(fields.density->at(Vec3(0.79F, 0.0F, 0.0F)), 0.0F);
  EXPECT_EQ(fields.density->at(Vec3(0.0F, 1.01F, 0.0F)), 0.0F);
  EXPECT_NEAR(fields.tint->at(Vec3(0.9F, 0.0F, 0.0F)).z, 1.0F, 1e-6F);
}

// Each part of a way lies in the cell whose bounds it is told with, and the parts make the whole.
TEST(MajorantGrid, WalksWithoutGapsAndWithTheRightBounds) {
  const auto grid = random_grid(24, 11);
  const auto density = make_grid_density(grid);
  const DensityField& field = *density;
  test::Random random(9);
  for (const Vec3i& cells : {Vec3i(1), Vec3i(3, 9, 5), Vec3i(24)}) {
    const MajorantGrid majorants(field, cells);
    for (int n = 0; n < 3000; ++n) {
      const Vec3 from = within({Vec3(-20.0F), Vec3(45.0F)}, random);
      Vec3 direction = random.direction();
      if (n % 5 == 0) direction[n % 3] = 0.0F;
      if (n % 10 == 0) direction = Vec3(0.0F, n % 20 == 0 ? 1.0F : -1.0F, 0.0F);
      const float t_max = n % 7 == 0 ? kInfinity : 60.0F * random.uniform();
      const auto span = majorants.inside(from, direction, t_max);
      float reached = span.begin;
      int parts = 0;
      majorants.walk(from, direction, t_max, [&](float begin, float end, const Extent& extent) {
        EXPECT_EQ(begin, reached);
        EXPECT_GT(end, begin);
        reached = end;
        ++parts;
        for (int k = 0; k < 3; ++k) {
          const float value = field.at(from + glm::mix(begin, end, random.uniform()) * direction);
          EXPECT_GE(value, extent.least - 1e-4F);
          EXPECT_LE(value, extent.greatest + 1e-4F);
        }
        return true;
      });
      if (span.begin < span.end) {
        EXPECT_EQ(reached, span.end);
        EXPECT_LE(parts, cells.x + cells.y + cells.z + 1);
      } else {
        EXPECT_EQ(parts, 0);
      }
    }
  }
}

}  // namespace
}  // namespace hyades::core
