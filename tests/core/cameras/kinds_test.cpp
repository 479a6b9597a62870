// What tells the kinds of cameras apart: where they look, and what their keys mean.

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/elementary.h"
#include "core/cameras/axes.h"
#include "core/cameras/make_camera.h"

namespace hyades::core {
namespace {

CameraPose looking(const Vec3& from, const Vec3& at) {
  CameraPose pose;
  pose.from = from;
  pose.at = at;
  return pose;
}

void expect_near(const Vec3& a, const Vec3& b, float tolerance = 1e-5F) {
  EXPECT_LT(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Shift, MovesThePictureInItsPlane) {
  CameraPose pose = looking({0, 0, 0}, {0, 0, -1});
  pose.fov = 2.0F * atan2(0.5F, 1.0F);  // the picture is 1 high at distance 1
  pose.shift = {0.25F, 0.5F};
  const auto camera = make_perspective_camera({pose}, {200, 100}, {});
  // Its middle lies half of its height above the axis, and a quarter of its width to the right.
  expect_near(camera->generate({100, 50}, {}, 0.0F).direction,
              glm::normalize(Vec3(0.5F, 0.5F, -1)));
  expect_near(camera->generate({50, 100}, {}, 0.0F).direction, {0, 0, -1});
}

TEST(Shift, IsACropOfAWiderPicture) {
  CameraPose pose = looking({1, 2, 3}, {0, 1, -1});
  const auto straight = make_perspective_camera({pose}, {80, 60}, {});
  pose.shift = {0.3F, -0.4F};
  const auto shifted = make_perspective_camera({pose}, {80, 60}, {});
  for (const Vec2 film : {Vec2(0, 0), Vec2(17, 40), Vec2(80, 60)}) {
    expect_near(shifted->generate(film, {}, 0.0F).direction,
                straight->generate(film + Vec2(0.3F * 80.0F, 0.4F * 60.0F), {}, 0.0F).direction);
  }
}

TEST(OrthographicCamera, ShowsAsMuchAsItsHeightSays) {
  CameraPose pose = looking({0, 0, 5}, {0, 0, 0});
  pose.height = 3.0F;
  const auto camera = make_orthographic_camera({pose}, {200, 100}, {});
  const Ray corner = camera->generate({0, 0}, {0.2F, 0.7F}, 0.0F);
  expect_near(corner.origin, {-3.0F, 1.5F, 5.0F});
  expect_near(corner.direction, {0, 0, -1});
  expect_near(camera->generate({200, 100}, {}, 0.0F).origin, {3.0F, -1.5F, 5.0F});
  EXPECT_FLOAT_EQ(camera->depth_of({7, -3, 1}, 0.0F), 4.0F);
  EXPECT_FALSE(camera->connect({0, 0, 6}, {}, 0.0F));
  EXPECT_FLOAT_EQ(camera->pixel_at({1, 2, -50}, 0.0F).width, 0.03F);
}

TEST(OrthographicCamera, LensRaysMeetInThePlaneOfFocusAtEverySpotOfThePicture) {
  CameraPose pose = looking({0, 0, 5}, {0, 0, 0});
  pose.lens_radius = 0.5F;
  pose.focus_distance = 4.0F;
  const auto camera = make_orthographic_camera({pose}, {100, 100}, {});
  for (const Vec2 film : {Vec2(50, 50), Vec2(3, 80)}) {
    const Vec3 sharp = camera->generate(film, {0.5F, 0.5F}, 0.0F).origin + Vec3(0, 0, -4);
    for (const Vec2 lens : {Vec2(0.01F, 0.02F), Vec2(0.9F, 0.3F), Vec2(0.4F, 0.99F)}) {
      const Ray ray = camera->generate(film, lens, 0.0F);
      expect_near(ray.origin + ray.direction * (-4.0F / ray.direction.z), sharp);
      // Through one place of the lens all are parallel.
      expect_near(ray.direction, camera->generate({77, 12}, lens, 0.0F).direction);
    }
  }
}

/// What it takes towards +x is an environment map: u = atan2(z, x) / 2 pi + 0.5, v = acos(y) / pi.
TEST(EquirectangularCamera, TakesEnvironmentMaps) {
  const auto camera = make_equirectangular_camera({looking({1, 2, 3}, {9, 2, 3})}, {64, 32});
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Vec3 d = camera->generate({x + 0.5F, y + 0.5F}, {}, 0.0F).direction;
      EXPECT_NEAR((std::atan2(d.z, d.x) / (2.0F * kPi) + 0.5F) * 64.0F, x + 0.5F, 1e-4F);
      EXPECT_NEAR(std::acos(d.y) / kPi * 32.0F, y + 0.5F, 1e-3F);
    }
  }
  EXPECT_FLOAT_EQ(camera->depth_of({1, 5, 7}, 0.0F), 5.0F);
}

/// Whatever it looks at, its horizon is level; what is to the right of it is on the right.
TEST(EquirectangularCamera, StandsUpright) {
  const auto camera = make_equirectangular_camera({looking({0, 1, 0}, {0, -7, -2})}, {64, 32});
  expect_near(camera->generate({32, 16}, {}, 0.0F).direction, {0, 0, -1});
  expect_near(camera->generate({48, 16}, {}, 0.0F).direction, {1, 0, 0});
  expect_near(camera->generate({10, 0}, {}, 0.0F).direction, {0, 1, 0});
  expect_near(camera->generate({10, 32}, {}, 0.0F).direction, {0, -1, 0});
  // Straight down says nothing about where the middle is.
  const auto down = make_equirectangular_camera({looking({0, 1, 0}, {0, -7, 0})}, {64, 32});
  expect_near(down->generate({32, 16}, {}, 0.0F).direction, {0, 0, -1});
  const CameraAxes axes = axes_upright({0, 0, -3}, {0, 0, 1});
  expect_near(axes.up, {0, 0, 1});
  expect_near(axes.forward, {1, 0, 0});
}

TEST(Cameras, NoPosesAreADefaultOne) {
  EXPECT_TRUE(
      std::isfinite(make_orthographic_camera({}, {0, 0}, {})->generate({}, {}, 0.0F).origin.x));
  expect_near(make_equirectangular_camera({}, {2, 1})->generate({1, 0.5F}, {}, 0.0F).direction,
              {0, 0, -1});
}

}  // namespace
}  // namespace hyades::core
