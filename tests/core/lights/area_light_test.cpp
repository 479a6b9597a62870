#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/core/lights/lamp.h"

namespace hyades::core {
namespace {

TEST(DiskLight, IrradianceOnItsAxis) {
  // E = pi L r^2 / (r^2 + h^2)
  const Lamp lamp(quadric(Shape::Kind::disk, 0.75F), {Mat4(1.0F)});
  for (const float h : {0.25F, 1.0F, 10.0F}) {
    const double r2 = 0.75 * 0.75;
    const double h2 = static_cast<double>(h) * static_cast<double>(h);
    const double expected = M_PI * static_cast<double>(luminance(kRadiance)) * r2 / (r2 + h2);
    EXPECT_TRUE(
        test::mean_is(test::irradiance(*lamp.light, {0, h, 0}, {0, -1, 0}, 2000000), expected));
  }
  EXPECT_FALSE(lamp.light->sample_direct({0, -1, 0}, 0.0F, 0.1F, {0.4F, 0.6F}));
  EXPECT_FALSE(lamp.light->sample_direct({2, 0, 0}, 0.0F, 0.1F, {0.4F, 0.6F}));  // edge-on
}

TEST(DiskLight, IsChosenAsItSays) {
  const Lamp lamp(quadric(Shape::Kind::disk, 0.75F), {Mat4(1.0F)});
  expect_places_follow(lamp, test::DiskChart(0.75), {0.2F, 0.5F, 0.1F}, 4);
  expect_places_follow(lamp, test::DiskChart(0.75), {3, 0.4F, -1}, 4);
  expect_samples_agree_with_rays(lamp, {0.2F, 0.5F, 0.1F});
  expect_samples_agree_with_rays(lamp, {3, 0.4F, -1});
  const Lamp skew(quadric(Shape::Kind::disk, 0.75F), {skewed()}, true);
  expect_places_follow(skew, test::DiskChart(0.75), {0, -1, 2}, 4);
  expect_places_follow(skew, test::DiskChart(0.75), {0, 3, -2}, 4);
  expect_samples_agree_with_rays(skew, {0, 3, -2});
}

TEST(CylinderLight, IsChosenAsItSays) {
  const Lamp lamp(quadric(Shape::Kind::cylinder, 0.5F, 2.0F), {moved({0, -1, 0})}, true);
  const test::CylinderChart chart(0.5, 2.0);
  expect_places_follow(lamp, chart, {2, 0.5F, 0.3F}, 3);     // outside
  expect_places_follow(lamp, chart, {0.1F, 0.2F, 0.3F}, 3);  // inside
  expect_samples_agree_with_rays(lamp, {2, 0.5F, 0.3F});
  expect_samples_agree_with_rays(lamp, {0.1F, 0.2F, 0.3F});
  const Lamp skew(quadric(Shape::Kind::cylinder, 0.5F, 2.0F), {skewed()}, true);
  expect_places_follow(skew, chart, {0, -1, 3}, 3);
  expect_samples_agree_with_rays(skew, {0, -1, 3});
}

TEST(MeshLight, RectangleIrradianceByQuadrature) {
  // In the plane y = 2, shining down.
  const Mat4 down = glm::scale(moved({0, 2, 0}), {1, -1, -1});
  const Lamp lamp(mesh(make_rectangle({1.5F, 0.8F})), {down});
  const Vec3d from(0.3, 0.5, -0.2);
  const double expected =
      static_cast<double>(luminance(kRadiance)) * test::integrate2(
                                                      [&](double x, double z) {
                                                        const Vec3d d = Vec3d(x, 2.0, z) - from;
                                                        const double d2 = glm::dot(d, d);
                                                        return d.y * d.y / (d2 * d2);
                                                      },
                                                      -0.75, 0.75, -0.4, 0.4);
  EXPECT_TRUE(
      test::mean_is(test::irradiance(*lamp.light, Vec3(from), {0, 1, 0}, 1000000), expected));
  EXPECT_FALSE(lamp.light->sample_direct({0, 3, 0}, 0.0F, 0.1F, {0.4F, 0.6F}));  // behind
  const test::BoxChart chart({1.5, 0.0, 0.8});
  expect_places_follow(lamp, chart, {0.3F, 1.7F, 0.1F}, 2);
  expect_places_follow(lamp, chart, Vec3(from), 2);
  expect_samples_agree_with_rays(lamp, Vec3(from));
}

TEST(MeshLight, BoxIsChosenFromOutsideAndInside) {
  const Lamp lamp(mesh(make_box({1, 2, 0.5F})), {skewed()}, true);
  const test::BoxChart chart({1.0, 2.0, 0.5});
  expect_places_follow(lamp, chart, {0, -2, 2}, 2);
  expect_places_follow(lamp, chart, {0.5F, 1.0F, -0.3F}, 2);
  expect_samples_agree_with_rays(lamp, {0, -2, 2});
  expect_samples_agree_with_rays(lamp, {0.5F, 1.0F, -0.3F});
}

TEST(MeshLight, DegenerateTrianglesAreNeverChosen) {
  auto triangles = std::make_shared<TriangleMesh>();
  triangles->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  triangles->triangles = {{0, 1, 3}, {0, 1, 2}, {2, 2, 2}};
  finish_mesh(*triangles);
  const Lamp lamp(mesh(triangles), {Mat4(1.0F)}, true);
  EXPECT_NEAR(surface_area(*lamp.world, 0), 0.5, 1e-7);
  test::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const auto s = lamp.light->sample_direct({0, 0, 2}, 0.0F, random.uniform(), random.uniform2());
    ASSERT_TRUE(s);
    EXPECT_LE(s->position.x + s->position.y, 1.0001F);
  }
}

TEST(AreaLight, WithoutAreaOrRadianceGivesNothing) {
  auto triangles = std::make_shared<TriangleMesh>();
  triangles->positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  triangles->triangles = {{0, 1, 2}};
  finish_mesh(*triangles);
  const Lamp flat(mesh(triangles), {Mat4(1.0F)}, true);
  EXPECT_EQ(flat.light->power(), 0.0F);
  EXPECT_EQ(surface_area(*flat.world, 0), 0.0);
  EXPECT_FALSE(flat.light->sample_direct({0, 0, 1}, 0.0F, 0.5F, {0.5F, 0.5F}));

  Lamp dark(quadric(Shape::Kind::sphere, 1.0F), {Mat4(1.0F)});
  dark.light = make_area_light(*dark.world, 0, {});
  EXPECT_EQ(dark.light->power(), 0.0F);
  EXPECT_FALSE(dark.light->sample_direct({0, 0, 3}, 0.0F, 0.5F, {0.5F, 0.5F}));
}

TEST(AreaLight, PowerIsPiTimesAreaTimesRadiance) {
  const Lamp lamp(mesh(make_rectangle({2, 3})), {Mat4(1.0F)});
  EXPECT_NEAR(lamp.light->power(), 6.0 * M_PI * static_cast<double>(luminance(kRadiance)), 1e-3);
}

TEST(SurfaceArea, OfEveryShape) {
  const auto area = [](const Shape& shape, const Mat4& m) {
    return surface_area(*Lamp(shape, {m}).world, 0);
  };
  const Mat4 id(1.0F);
  EXPECT_NEAR(area(quadric(Shape::Kind::sphere, 2.0F), id), 16.0 * M_PI, 1e-5);
  EXPECT_NEAR(area(quadric(Shape::Kind::disk, 2.0F), id), 4.0 * M_PI, 1e-5);
  EXPECT_NEAR(area(quadric(Shape::Kind::cylinder, 2.0F, 3.0F), id), 12.0 * M_PI, 1e-5);
  EXPECT_NEAR(area(mesh(make_box({1, 2, 3})), id), 22.0, 1e-5);
  EXPECT_NEAR(area(mesh(make_rectangle({2, 3})), glm::scale(id, {2, 5, 4})), 48.0, 1e-4);
  // Stretched ones: the area element by numerical differences of the parametrisation.
  const auto numeric = [&](const std::function<Vec3d(double, double)>& at) {
    constexpr double h = 1e-5;
    return test::integrate2(
        [&](double u, double v) {
          const Vec3d a = (at(u + h, v) - at(u - h, v)) / (2.0 * h);
          const Vec3d b = (at(u, v + h) - at(u, v - h)) / (2.0 * h);
          const Vec3d n = glm::cross(a, b);
          return std::sqrt(glm::dot(n, n));
        },
        1e-4, 1.0 - 1e-4, 1e-4, 1.0 - 1e-4, 1e-5);
  };
  const glm::dmat3 m{Mat3(skewed())};
  EXPECT_NEAR(area(quadric(Shape::Kind::sphere, 0.7F), skewed()) / numeric([&](double u, double v) {
                const double z = 2.0 * u - 1.0;
                const double r = std::sqrt(std::max(1.0 - z * z, 0.0));
                return m * (0.7 * Vec3d(r * std::cos(2 * M_PI * v), r * std::sin(2 * M_PI * v), z));
              }),
              1.0, 2e-3);
  EXPECT_NEAR(
      area(quadric(Shape::Kind::cylinder, 0.7F, 2.0F), skewed()) / numeric([&](double u, double v) {
        return m * Vec3d(0.7 * std::cos(2 * M_PI * v), 2.0 * u, 0.7 * std::sin(2 * M_PI * v));
      }),
      1.0, 1e-3);
}

TEST(MovingLight, IsChosenWhereItIsAtTheTime) {
  // Grows, turns and flies while the shutter is open; the turn makes it flat in between.
  Mat4 end = glm::rotate(moved({0, 0.5F, -1}), 1.2F, Vec3(0, 0, 1));
  end = glm::scale(end, {2, 1, 1});
  const std::vector<Mat4> way{moved({0, 0, -3}), end};
  const auto expect_right = [&](const Shape& shape, const test::SurfaceChart& chart) {
    const Lamp lamp(shape, way, true);
    expect_samples_agree_with_rays(lamp, {0.2F, 1.3F, 1}, 0.0F);
    expect_samples_agree_with_rays(lamp, {0.2F, 1.3F, 1}, 0.6F);
    expect_places_follow(lamp, chart, {0.2F, 1.3F, 1}, 4, 0.6F);
  };
  expect_right(mesh(make_box({1, 1, 0.2F})), test::BoxChart({1.0, 1.0, 0.2}));
  expect_right(quadric(Shape::Kind::sphere, 0.6F), test::SphereChart(0.6));
  expect_right(quadric(Shape::Kind::disk, 0.6F), test::DiskChart(0.6));
  expect_right(quadric(Shape::Kind::cylinder, 0.4F, 1.0F), test::CylinderChart(0.4, 1.0));
}

TEST(MovingLight, RoundSphereIsChosenByItsCap) {
  const Lamp lamp(quadric(Shape::Kind::sphere, 1.0F),
                  {moved({0, 0, 2}), glm::scale(moved({0, 0, 4}), Vec3(3.0F))});
  // At half time: centre (0, 0, 3), radius 2.
  const double expected = M_PI * static_cast<double>(luminance(kRadiance)) * 4.0 / 9.0;
  const auto e = test::irradiance(*lamp.light, {0, 0, 0}, {0, 0, 1}, 100000, 0.5F);
  EXPECT_TRUE(test::mean_is(e, expected));
}

}  // namespace
}  // namespace hyades::core
