#pragma once

#include "core/lights/make_light.h"
#include "tests/core/lights/light_checks.h"

/// What tests of skies share.
namespace hyades::core {

inline Rgb seen(const Light& light, const Vec3& towards) { return light.radiance({}, -towards); }

/// T1 and T2 for a sky: directions follow pdf_direct, samples report it and what a ray would see.
inline void expect_sampled_right(const Light& light, uint64_t seed, double tolerance = 1e-4) {
  EXPECT_TRUE(test::directions_follow(
      [&](test::Random& random) -> std::optional<Vec3> {
        const auto s = light.sample_direct({1, 2, 3}, 0.0F, random.uniform(), random.uniform2());
        if (!s) return std::nullopt;
        return s->direction;
      },
      [&](const Vec3& d) {
        return static_cast<double>(light.pdf_direct({1, 2, 3}, d, {}));
      },
      test::sphere_test(tolerance, seed)));
  test::Random random(seed);
  for (int i = 0; i < 10000; ++i) {
    const auto s = light.sample_direct({1, 2, 3}, 0.0F, random.uniform(), random.uniform2());
    if (!s) continue;
    test::expect_sound(*s);
    EXPECT_EQ(s->distance, kInfinity);
    EXPECT_FALSE(s->delta);
    ASSERT_NEAR(light.pdf_direct({}, s->direction, {}) / s->pdf, 1.0F, 1e-4F);
    ASSERT_EQ(seen(light, s->direction), s->radiance);
  }
}

}  // namespace hyades::core
