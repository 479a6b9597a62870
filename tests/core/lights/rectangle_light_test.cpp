#include "core/lights/rectangle_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/lights/lamp.h"

namespace hyades::core {
namespace {

/// The solid angle of make_rectangle(size) seen from `from`, by quadrature.
double solid_angle(const Vec2& size, const Vec3& from) {
  return test::integrate2(
      [&](double x, double z) {
        const Vec3d d = Vec3d(x, 0.0, z) - Vec3d(from);
        return std::abs(d.y) / std::pow(glm::dot(d, d), 1.5);
      },
      -0.5 * static_cast<double>(size.x), 0.5 * static_cast<double>(size.x),
      -0.5 * static_cast<double>(size.y), 0.5 * static_cast<double>(size.y), 1e-7);
}

TEST(RectangleLight, DensityIsOneOverItsSolidAngle) {
  const Vec2 size(1.5F, 0.8F);
  const Lamp lamp(mesh(make_rectangle(size)), {Mat4(1.0F)}, true);
  const Vec3 places[] = {{0, 0.3F, 0}, {0.2F, 0.01F, 0.1F}, {2, 0.5F, 1}, {0.75F, -0.4F, 0.4F}};
  for (const Vec3& from : places) {
    const auto s = lamp.light->sample_direct(from, 0.0F, 0.5F, {0.3F, 0.6F});
    ASSERT_TRUE(s);
    EXPECT_NEAR(static_cast<double>(s->pdf) * solid_angle(size, from), 1.0, 1e-4);
  }
}

TEST(RectangleLight, IsChosenAsItSaysNearAndFar) {
  const Mat4 tilted = glm::rotate(moved({0.3F, -0.2F, 0.1F}), 0.8F, glm::normalize(Vec3(1, 2, 3)));
  const Lamp lamp(mesh(make_rectangle({1.5F, 0.8F})), {tilted}, true);
  const test::BoxChart chart({1.5, 0.0, 0.8});
  // Far, where it is chosen by area; at the change to solid angles; near; beside; behind.
  const Vec3 places[] = {{0, 30, 2}, {1, 6, 3}, {0, 0.5F, 0}, {0.2F, 0.1F, 0}, {-2, 1, 0.3F}};
  for (const Vec3& local : places) {
    for (const float side : {1.0F, -1.0F}) {
      const Vec3 from = transform_point(tilted, {local.x, side * local.y, local.z});
      expect_places_follow(lamp, chart, from, 10);
      expect_samples_agree_with_rays(lamp, from);
    }
  }
}

TEST(RectangleLight, VariesLittleNearby) {
  // By area the estimate's spread would be above 1 here; by solid angle only the cosine varies.
  const Lamp lamp(mesh(make_rectangle({2, 2})), {Mat4(1.0F)});
  const auto e = test::irradiance(*lamp.light, {0.3F, 0.1F, 0.2F}, {0, -1, 0}, 50000);
  EXPECT_LT(std::sqrt(e.variance()) / e.mean(), 0.65);
}

TEST(RectangleLight, DoesNotLightItself) {
  const Mat4 tilted = glm::rotate(moved({1.3F, -0.2F, 0.1F}), 0.8F, glm::normalize(Vec3(1, 2, 3)));
  const Lamp lamp(mesh(make_rectangle({1.5F, 0.8F})), {tilted}, true);
  test::Random random(11);
  for (int i = 0; i < 300; ++i) {
    const SurfacePoint on = lamp.world->triangle_point(0, i % 2, random.uniform(0.0F, 0.5F),
                                                       random.uniform(0.0F, 0.5F), 0);
    for (const Vec3& side : {on.ng, -on.ng}) {
      const auto e = test::irradiance(*lamp.light, on.position, side, 20);
      EXPECT_LT(e.mean(), 1e-4 * static_cast<double>(luminance(kRadiance)));
    }
  }
}

TEST(RectangleLight, HoldsInItsPlaneAndAtAnyScale) {
  for (const float scale : {1e-3F, 1.0F, 1e6F}) {
    const Lamp lamp(mesh(make_rectangle(Vec2(scale))), {moved(Vec3(scale))}, true);
    test::Random random(3);
    for (const float height : {0.0F, 1e-7F, 1e-4F, 1.0F, 1e4F}) {
      for (int i = 0; i < 300; ++i) {
        const Vec3 from =
            scale * (Vec3(1.0F) + Vec3(random.uniform(-1, 1), height, random.uniform(-1, 1)));
        const auto s = lamp.light->sample_direct(from, 0.0F, random.uniform(), random.uniform2());
        if (s) test::expect_sound(*s);
      }
      // Corners and edges, where terms vanish.
      for (const Vec2& at : {Vec2(0.5F, 0.5F), Vec2(0.5F, 0), Vec2(0, 0)}) {
        const Vec3 from = scale * (Vec3(1.0F) + Vec3(at.x, height, at.y));
        const auto s = lamp.light->sample_direct(from, 0.0F, 0.5F, random.uniform2());
        if (s) test::expect_sound(*s);
      }
    }
  }
}

TEST(FindRectangle, OnlyWhereThereIsOne) {
  const auto found = [](const Shape& shape, const std::vector<Mat4>& way) {
    return find_rectangle(*Lamp(shape, way).world, 0).has_value();
  };
  const Shape square = mesh(make_rectangle({1, 1}));
  EXPECT_TRUE(found(square, {Mat4(1.0F)}));
  EXPECT_TRUE(found(square, {skewed_but_round()}));
  EXPECT_TRUE(found(square, {glm::scale(Mat4(1.0F), {2, -1, 7})}));
  EXPECT_FALSE(found(square, {skewed()}));                      // a parallelogram
  EXPECT_FALSE(found(square, {Mat4(1.0F), moved({0, 1, 0})}));  // moves
  EXPECT_FALSE(found(mesh(make_box({1, 1, 1})), {Mat4(1.0F)}));
  EXPECT_FALSE(found(quadric(Shape::Kind::disk, 1.0F), {Mat4(1.0F)}));

  auto bent = std::make_shared<TriangleMesh>(*make_rectangle({1, 1}));
  bent->positions[bent->triangles[0][0]].y = 0.3F;
  finish_mesh(*bent);
  EXPECT_FALSE(found(mesh(bent), {Mat4(1.0F)}));
  auto folded = std::make_shared<TriangleMesh>(*make_rectangle({1, 1}));
  std::swap(folded->triangles[1][0], folded->triangles[1][1]);  // one side faces the other way
  EXPECT_FALSE(found(mesh(folded), {Mat4(1.0F)}));
}

}  // namespace
}  // namespace hyades::core
