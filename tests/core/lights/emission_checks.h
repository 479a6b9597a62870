#pragma once

#include <optional>
#include <string>

#include "tests/core/lights/lamp.h"

/// What tests of where light paths begin share.
namespace hyades::core {

inline std::optional<EmissionSample> emitted(const Light& light, float time, test::Random& random) {
  const float pick = random.uniform();
  const Vec2 place = random.uniform2();
  return light.sample_emission(time, pick, place, random.uniform2());
}

/// Directions around a normal cut into eight parts of each side, which cosines choose alike.
struct CosineParts {
  bool two_sided;

  size_t count() const { return two_sided ? 16 : 8; }
  size_t find(const Vec3& local) const {
    const size_t azimuth = (local.x > 0.0F ? 1U : 0U) + (local.y > 0.0F ? 2U : 0U);
    return azimuth + (local.z * local.z > 0.5F ? 4U : 0U) + (local.z < 0.0F ? 8U : 0U);
  }
};

/// Places have density pdf_place per area, which integrates to 1; directions are in proportion to
/// the cosine whatever the place. An error of 2 % in half of the joint cells is noticed.
inline void expect_emission_follows(const Lamp& lamp, const test::SurfaceChart& chart,
                                    bool two_sided, int tests, float time = 0.0F) {
  const std::vector<double> places =
      chart_shares(lamp, chart, time, [&](const SurfacePoint& on, const Vec3d&, const Vec3d&) {
        return static_cast<double>(lamp.light->pdf_place(on, Vec3(0.0F)));
      });
  EXPECT_NEAR(std::accumulate(places.begin(), places.end(), 0.0), 1.0, 2e-3);
  const CosineParts parts{two_sided};
  const double alpha = test::sidak(0.01, tests);
  const size_t cells = places.size() * parts.count();
  const int64_t count =
      test::required_chi_squared_samples(static_cast<int>(cells) - 1, 0.02, alpha, 0.99);
  std::vector<double> expected;
  for (const double share : places) {
    expected.insert(expected.end(), parts.count(),
                    share * static_cast<double>(count) / static_cast<double>(parts.count()));
  }
  std::vector<double> observed(cells, 0.0);
  test::Random random(17);
  for (int64_t i = 0; i < count; ++i) {
    const auto s = emitted(*lamp.light, time, random);
    if (!s) continue;
    const Vec3 local = Frame::around(s->on.ng).to_local(s->direction);
    ASSERT_TRUE(two_sided || local.z >= 0.0F);
    observed[chart_cell(lamp, chart, s->on.position, time) * parts.count() + parts.find(local)] +=
        1.0;
  }
  const auto result = test::chi_squared(observed, expected);
  EXPECT_GT(result.p, alpha) << "chi-squared " << result.statistic << " with " << result.degrees
                             << " degrees of freedom";
}

/// A sample's weight and densities are those that a camera path finds at its place, and in the mean
/// it carries the light's power (of the moment: `power`).
inline void expect_emission_agrees(const Lamp& lamp, double power, float time = 0.0F,
                                   int samples = 20000) {
  test::Random random(23);
  test::Moments flux;
  int compared = 0;
  for (int i = 0; i < samples; ++i) {
    const auto s = emitted(*lamp.light, time, random);
    ASSERT_TRUE(s);
    flux.add(static_cast<double>(luminance(s->weight)));
    ASSERT_NEAR(glm::dot(s->direction, s->direction), 1.0F, 1e-5F);
    ASSERT_EQ(s->on.time, time);
    ASSERT_EQ(lamp.light->pdf_outward(s->on.ng, s->direction), s->pdf_direction);
    const float cosine = std::abs(glm::dot(s->on.ng, s->direction));
    const Rgb weight =
        lamp.light->radiance(s->on, s->direction) * cosine / (s->pdf_place * s->pdf_direction);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(s->weight[c] / weight[c], 1.0F, 1e-5F);
    if (i % 10 != 0) continue;
    // Met by a ray from where it shines to; edges may belong to another side.
    const Ray ray{s->on.position + 1e-2F * s->on.ng, -s->on.ng, 2e-2F, time};
    const auto hit = lamp.world->intersect(ray, RayKind::diffuse);
    if (!hit) continue;
    const SurfacePoint met = lamp.world->surface(ray, *hit);
    if (glm::dot(met.ng, s->on.ng) < 0.99F) continue;
    ASSERT_LT(glm::length(met.position - s->on.position), 1e-4F);
    ASSERT_NEAR(lamp.light->pdf_place(met, s->direction) / s->pdf_place, 1.0F, 1e-3F);
    ++compared;
  }
  EXPECT_GT(compared, 1800);
  if (std::sqrt(flux.variance()) < 1e-4 * flux.mean()) {
    EXPECT_NEAR(flux.mean() / power, 1.0, 1e-4);
  } else {
    EXPECT_TRUE(test::mean_is(flux, power, {.relative_error = 0.02}));
  }
}

struct LampCase {
  const char* name;
  Shape shape;
  std::shared_ptr<const test::SurfaceChart> chart;
};

/// One of each kind of light on a surface.
inline std::vector<LampCase> lamps() {
  return {
      {"sphere", quadric(Shape::Kind::sphere, 0.6F), std::make_shared<test::SphereChart>(0.6)},
      {"disk", quadric(Shape::Kind::disk, 0.75F), std::make_shared<test::DiskChart>(0.75)},
      {"cylinder", quadric(Shape::Kind::cylinder, 0.4F, 1.0F),
       std::make_shared<test::CylinderChart>(0.4, 1.0)},
      {"box", mesh(make_box({1, 2, 0.5F})), std::make_shared<test::BoxChart>(Vec3d(1.0, 2.0, 0.5))},
      {"rectangle", mesh(make_rectangle({1.5F, 0.8F})),
       std::make_shared<test::BoxChart>(Vec3d(1.5, 0.0, 0.8))}};
}

}  // namespace hyades::core
