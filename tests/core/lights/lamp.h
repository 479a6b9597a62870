#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "core/lights/make_light.h"
#include "tests/core/lights/light_checks.h"
#include "tests/core/lights/surface_chart.h"
#include "tests/support/means.h"
#include "tests/support/quadrature.h"

/// What tests of lights on surfaces share.
namespace hyades::core {

inline const Rgb kRadiance(3.0F, 2.0F, 1.0F);

/// A shape put into a world, moving from one matrix to the next.
inline Placement placed(const Shape& shape, const std::vector<Mat4>& to_world) {
  Placement placement;
  placement.shape = shape;
  placement.to_world = to_world;
  return placement;
}

/// One shape alone in the world, giving off light.
struct Lamp {
  GeometryCache cache;
  std::shared_ptr<const World> world;
  LightPtr light;

  Lamp(const Shape& shape, const std::vector<Mat4>& to_world, bool two_sided = false)
      : Lamp(shape, to_world, SurfaceEmission{kRadiance, two_sided}) {}

  Lamp(const Shape& shape, const std::vector<Mat4>& to_world, const SurfaceEmission& emission) {
    auto built = build_world({placed(shape, to_world)}, cache);
    EXPECT_TRUE(built) << (built ? "" : built.error().message);
    world = *built;
    light = make_area_light(*world, 0, emission);
  }
};

inline Shape quadric(Shape::Kind kind, float radius, float height = 1.0F) {
  Shape shape;
  shape.kind = kind;
  shape.radius = radius;
  shape.height = height;
  return shape;
}

inline Shape mesh(std::shared_ptr<const TriangleMesh> triangles) {
  Shape shape;
  shape.mesh = std::move(triangles);
  return shape;
}

inline Mat4 moved(const Vec3& by) { return glm::translate(Mat4(1.0F), by); }

/// A transform that stretches, shears, turns and mirrors.
inline Mat4 skewed() {
  Mat4 m(1.0F);
  m[0] = Vec4(0.9F, 0.3F, -0.2F, 0.0F);
  m[1] = Vec4(-0.1F, -0.6F, 0.4F, 0.0F);
  m[2] = Vec4(0.3F, 0.2F, 1.7F, 0.0F);
  m[3] = Vec4(0.5F, 1.0F, -0.3F, 1.0F);
  return m;
}

/// A transform that turns, mirrors and keeps balls round.
inline Mat4 skewed_but_round() {
  const Mat4 m = glm::rotate(moved({0.2F, -0.4F, 0.1F}), 1.1F, glm::normalize(Vec3(1, 2, -1)));
  return glm::scale(m, {-0.9F, 0.9F, 0.9F});
}

/// What a ray from `from` meets: every surface on its way, not only the first, as choosing by area
/// may choose places that others hide.
inline std::vector<SurfacePoint> all_along(const World& world, const Vec3& from,
                                           const Vec3& direction, float time) {
  std::vector<SurfacePoint> points;
  Ray ray{from, direction, kInfinity, time};
  while (points.size() < 16) {
    const auto hit = world.intersect(ray, RayKind::diffuse);
    if (!hit) break;
    points.push_back(world.surface(ray, *hit));
    ray = spawn_ray(points.back(), direction);
    ray.time = time;
  }
  return points;
}

/// Cells of a side of a chart's patch.
inline constexpr int kChartGrid = 6;

inline size_t chart_cell(const Lamp& lamp, const test::SurfaceChart& chart, const Vec3& position,
                         float time) {
  const glm::dmat4 inverse = glm::inverse(glm::dmat4(lamp.world->transform_at(0, time)));
  const test::ChartPlace p = chart.find(Vec3d(inverse * glm::dvec4(Vec3d(position), 1.0)));
  const auto column = std::clamp(static_cast<int>(p.u * kChartGrid), 0, kChartGrid - 1);
  const auto row = std::clamp(static_cast<int>(p.v * kChartGrid), 0, kChartGrid - 1);
  return static_cast<size_t>((p.patch * kChartGrid + row) * kChartGrid + column);
}

/// The integral over each cell of a chart of a density per area, which is asked for with the point
/// as rays find it, and its place and normal in double.
inline std::vector<double> chart_shares(
    const Lamp& lamp, const test::SurfaceChart& chart, float time,
    const std::function<double(const SurfacePoint&, const Vec3d&, const Vec3d&)>& per_area) {
  const glm::dmat4 matrix(lamp.world->transform_at(0, time));
  const glm::dmat3 linear(matrix);
  const auto in_world = [&](const test::ChartPlace& p) {
    return Vec3d(matrix * glm::dvec4(chart.position(p), 1.0));
  };
  const auto density = [&](const test::ChartPlace& place) {
    // Differences need room, and rays must not pass beside an edge.
    constexpr double h = 1e-6;
    const test::ChartPlace p{place.patch, std::clamp(place.u, 2.0 * h, 1.0 - 2.0 * h),
                             std::clamp(place.v, 2.0 * h, 1.0 - 2.0 * h)};
    const Vec3d du = in_world({p.patch, p.u + h, p.v}) - in_world({p.patch, p.u - h, p.v});
    const Vec3d dv = in_world({p.patch, p.u, p.v + h}) - in_world({p.patch, p.u, p.v - h});
    const double area = glm::length(glm::cross(du, dv)) / (4.0 * h * h);
    // The point itself as rays find it, from a little outside.
    const Vec3d position = in_world(p);
    const Vec3d normal = glm::normalize(glm::inverseTranspose(linear) * chart.normal(p));
    const Ray ray{Vec3(position + 1e-3 * normal), Vec3(-normal), kInfinity, time};
    const auto hit = lamp.world->intersect(ray, RayKind::diffuse);
    return hit ? per_area(lamp.world->surface(ray, *hit), position, normal) * area : 0.0;
  };
  std::vector<double> shares;
  for (int cell = 0; cell < kChartGrid * kChartGrid * chart.patches(); ++cell) {
    const int patch = cell / (kChartGrid * kChartGrid);
    const double u = cell % kChartGrid;
    const double v = cell / kChartGrid % kChartGrid;
    shares.push_back(test::integrate2(
        [&](double x, double y) {
          return density({patch, x, y});
        },
        u / kChartGrid, (u + 1.0) / kChartGrid, v / kChartGrid, (v + 1.0) / kChartGrid, 1e-5, 1,
        5));
  }
  return shares;
}

/// T1 for the places that are chosen, seen from `from`: in each cell of a chart of the surface, the
/// density per solid angle times the solid angle that the surface covers there, cos / distance^2
/// per area. The light is two-sided, or else sees `from` from everywhere. `tests`: how many of
/// these the calling test makes.
inline void expect_places_follow(const Lamp& lamp, const test::SurfaceChart& chart,
                                 const Vec3& from, int tests, float time = 0.0F) {
  std::vector<double> expected = chart_shares(
      lamp, chart, time, [&](const SurfacePoint& on, const Vec3d& position, const Vec3d& normal) {
        const Vec3d to_light = position - Vec3d(from);
        const double distance = glm::length(to_light);
        const double pdf =
            static_cast<double>(lamp.light->pdf_direct(from, Vec3(to_light / distance), on));
        return pdf * std::abs(glm::dot(normal, to_light)) / (distance * distance * distance);
      });
  EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), 1.0, 2e-3);
  const double alpha = test::sidak(0.01, tests);
  const int64_t count =
      test::required_chi_squared_samples(static_cast<int>(expected.size()) - 1, 0.01, alpha, 0.99);
  for (double& e : expected) e *= static_cast<double>(count);

  std::vector<double> observed(expected.size(), 0.0);
  test::Random random(5);
  for (int64_t i = 0; i < count; ++i) {
    const auto s = lamp.light->sample_direct(from, time, random.uniform(), random.uniform2());
    if (s) observed[chart_cell(lamp, chart, s->position, time)] += 1.0;
  }
  const auto result = test::chi_squared(observed, expected);
  EXPECT_GT(result.p, alpha) << "from " << from.x << ' ' << from.y << ' ' << from.z
                             << ": chi-squared " << result.statistic << " with " << result.degrees
                             << " degrees of freedom";
}

/// T2: a sample's numbers are those that a ray in its direction finds at its place, and nothing
/// stands between but what really does. `exact`: the radiance is the same everywhere.
inline void expect_samples_agree_with_rays(const Lamp& lamp, const Vec3& from, float time = 0.0F,
                                           bool exact = true) {
  test::Random random(9);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto s = lamp.light->sample_direct(from, time, random.uniform(), random.uniform2());
    if (!s) continue;
    test::expect_sound(*s);
    const auto points = all_along(*lamp.world, from, s->direction, time);
    const SurfacePoint* nearest = nullptr;
    float off = kInfinity;
    for (const SurfacePoint& p : points) {
      const float here = std::abs(glm::length(p.position - from) - s->distance);
      if (here < off) nearest = &p;
      off = std::min(off, here);
    }
    if (nearest == nullptr) continue;
    // The rounded direction meets the surface a little beside the place; the density and the
    // distance of a slanted one feel it, and edge-on it may meet the other side.
    const float cosine = std::abs(glm::dot(nearest->ng, s->direction));
    if (cosine < 0.02F) continue;
    ASSERT_LT(off, (1e-5F * s->distance + 1e-6F * glm::length(from)) / cosine);
    ASSERT_NEAR(lamp.light->pdf_direct(from, s->direction, *nearest) / s->pdf, 1.0F,
                5e-6F / (cosine * cosine) + 1e-5F);
    const Rgb met = lamp.light->radiance(*nearest, -s->direction);
    if (exact) {
      ASSERT_EQ(met, s->radiance);
    } else {
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(met[c] / s->radiance[c], 1.0F, 1e-3F);
    }
    SurfacePoint start;
    start.position = from;
    start.time = time;
    ASSERT_EQ(lamp.world->occluded(spawn_ray_to(start, s->position, 0.0F)),
              nearest != points.data());
    ++compared;
  }
  EXPECT_GT(compared, 400);
}

}  // namespace hyades::core
