#include "core/render/splat_placer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/base/hash.h"

namespace hyades::core {
namespace {

constexpr PixelRect kRegion{0, 0, 12, 10};
constexpr double kSigmas = 5.0;  // 600 tests of a correct placer fail together with 3.4e-4

struct Filter {
  FilterShape shape;
  float radius;
};
constexpr Filter kFilters[] = {
    {FilterShape::box, 0.5F},      {FilterShape::box, 1.3F},
    {FilterShape::triangle, 1.0F}, {FilterShape::triangle, 0.3F},
    {FilterShape::gaussian, 1.5F}, {FilterShape::blackman_harris, 1.5F},
    {FilterShape::mitchell, 2.0F}, {FilterShape::mitchell, 1.2F},
};

/// Sums and sums of squares by pixel of the red channel.
struct Sums {
  std::vector<double> value = std::vector<double>(static_cast<size_t>(kRegion.area()));
  std::vector<double> square = value;
  void add(const std::optional<PixelSplat>& splat) {
    if (!splat) return;
    value[splat->pixel] += double{splat->value[0]};
    square[splat->pixel] += double{splat->value[0]} * double{splat->value[0]};
  }
};

// A pixel's mean over 40,000 splats has a standard error of 0.005 at most times the filter's sum,
// so that the filter of a neighbour, or a sign, is dozens of them away.
TEST(SplatPlacer, APixelGetsTheFilterAtTheSplat) {
  for (const Filter& shape : kFilters) {
    const auto filter = make_pixel_filter(shape.shape, shape.radius);
    const SplatPlacer placer(*filter, shape.radius, kRegion);
    for (const Vec2& at : {Vec2(5.3F, 4.8F), Vec2(6.0F, 3.5F), Vec2(0.1F, 9.9F)}) {
      constexpr int kCount = 40000;
      Sums sums;
      for (uint64_t i = 0; i < kCount; ++i) sums.add(placer.place({at, Rgb(3.0F)}, mix64(i)));
      for (int y = 0; y < kRegion.y1; ++y) {
        for (int x = 0; x < kRegion.x1; ++x) {
          const auto i = static_cast<size_t>(y * kRegion.x1 + x);
          const double expected =
              3.0 * double{filter->evaluate(at - (Vec2(x, y) + Vec2(0.5F)))} * kCount;
          // And up to four splats where next to none is expected.
          const double error = std::sqrt(sums.square[i]) + 16.0 / kSigmas;
          EXPECT_NEAR(sums.value[i], expected, kSigmas * error)
              << static_cast<int>(shape.shape) << " radius " << shape.radius << " pixel " << x
              << ", " << y << " splat " << at.x << ", " << at.y;
        }
      }
    }
  }
}

// 400,000 splats, 1240 of them around each pixel: an error of the height of 1 % is more than five
// standard errors of the mean over all pixels; of one pixel's, 15 to 40 %.
TEST(SplatPlacer, AUniformDensityGivesAFlatPictureOfTheRightHeight) {
  for (const Filter& shape : kFilters) {
    const auto filter = make_pixel_filter(shape.shape, shape.radius);
    const SplatPlacer placer(*filter, shape.radius, kRegion);
    constexpr int kCount = 400000;
    constexpr float kMargin = 3.0F;
    const Vec2 size(static_cast<float>(kRegion.x1) + 2 * kMargin,
                    static_cast<float>(kRegion.y1) + 2 * kMargin);
    Sums sums;
    for (uint64_t i = 0; i < kCount; ++i) {
      const uint64_t place = mix64(3 * i);
      const Vec2 u(static_cast<float>(place >> 40U) * 0x1p-24F,
                   static_cast<float>(place & 0xFFFFFFU) * 0x1p-24F);
      sums.add(placer.place({u * size - Vec2(kMargin), Rgb(1.0F)}, mix64(3 * i + 1)));
    }
    const double density = kCount / (double{size.x} * double{size.y});
    double total = 0.0;
    double square = 0.0;
    for (size_t i = 0; i < sums.value.size(); ++i) {
      EXPECT_NEAR(sums.value[i], density, kSigmas * std::sqrt(sums.square[i])) << i;
      total += sums.value[i];
      square += sums.square[i];
    }
    EXPECT_NEAR(total / (density * static_cast<double>(kRegion.area())), 1.0,
                kSigmas * std::sqrt(square) / total)
        << static_cast<int>(shape.shape) << " radius " << shape.radius;
  }
}

TEST(SplatPlacer, ABoxOfOnePixelHoldsExactlyOne) {
  const auto filter = make_pixel_filter(FilterShape::box, 0.5F);
  const SplatPlacer placer(*filter, 0.5F, kRegion);
  for (uint64_t i = 0; i < 20000; ++i) {
    // Many on the edges.
    const float x = static_cast<float>(mix64(i) % (12 * 16)) / 16.0F;
    const float y = static_cast<float>(mix64(i + 1) % 10) + 0.5F;
    const auto placed = placer.place({{x, y}, Rgb(1, 2, 3)}, mix64(i + 2));
    ASSERT_TRUE(placed);
    EXPECT_EQ(placed->pixel, static_cast<uint32_t>(y) * 12 + static_cast<uint32_t>(x));
    EXPECT_EQ(placed->value, (std::array<float, 3>{1, 2, 3}));
  }
}

TEST(SplatPlacer, APixelDoesNotDependOnTheRegion) {
  const auto filter = make_pixel_filter(FilterShape::mitchell, 2.0F);
  const SplatPlacer placer(*filter, 2.0F, kRegion);
  const PixelRect part{3, 2, 7, 9};
  const SplatPlacer of_part(*filter, 2.0F, part);
  for (uint64_t i = 0; i < 20000; ++i) {
    const Vec2 at(static_cast<float>(mix64(i) % 1600) / 100.0F - 2.0F,
                  static_cast<float>(mix64(i + 9) % 1400) / 100.0F - 2.0F);
    const auto placed = placer.place({at, Rgb(1.0F)}, mix64(i + 5));
    const auto in_part = of_part.place({at, Rgb(1.0F)}, mix64(i + 5));
    const int x = placed ? static_cast<int>(placed->pixel % 12) : -1;
    const int y = placed ? static_cast<int>(placed->pixel / 12) : -1;
    ASSERT_EQ(in_part.has_value(), part.contains(x, y));
    if (!in_part) continue;
    EXPECT_EQ(in_part->pixel, static_cast<uint32_t>((y - 2) * 4 + x - 3));
    EXPECT_EQ(in_part->value, placed->value);
  }
}

TEST(SplatPlacer, PlacesBeyondAllPixelsHaveNone) {
  const auto filter = make_pixel_filter(FilterShape::gaussian, 1.5F);
  const SplatPlacer placer(*filter, 1.5F, kRegion);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float x : {-2.0F, 14.0F, 3e38F, -3e38F, kInfinity, -kInfinity, std::nanf("")}) {
    EXPECT_FALSE(placer.place({{x, 5.0F}, Rgb(1.0F)}, 77));
    EXPECT_FALSE(placer.place({{5.0F, x}, Rgb(1.0F)}, 77));
  }
}

}  // namespace
}  // namespace hyades::core
