#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/cameras/make_camera.h"
#include "tests/support/chi_squared.h"

namespace hyades::core {
namespace {

constexpr float kDegree = kPi / 180.0F;

CameraPose pose_at(const Vec3& from, const Vec3& at) {
  CameraPose pose;
  pose.from = from;
  pose.at = at;
  pose.fov = 40.0F * kDegree;
  return pose;
}

std::unique_ptr<Camera> still(const CameraPose& pose, Vec2i resolution, int blades = 0) {
  return make_perspective_camera({pose}, resolution, {blades, 0.0F});
}

void expect_close_vectors(const Vec3& a, const Vec3& b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

bool is_unit(const Vec3& v) { return std::abs(glm::dot(v, v) - 1.0F) < 1e-5F; }

TEST(PerspectiveCamera, LooksFromItsPlaceAtItsTarget) {
  const auto camera = still(pose_at({1, 2, 3}, {4, 2, -1}), {640, 480});
  const Ray ray = camera->generate({320, 240}, {0.3F, 0.9F}, 0.25F);
  expect_close_vectors(ray.origin, {1, 2, 3}, 0.0F);
  expect_close_vectors(ray.direction, {0.6F, 0, -0.8F}, 1e-6F);
  EXPECT_EQ(ray.time, 0.25F);
  EXPECT_EQ(ray.t_max, kInfinity);
}

TEST(PerspectiveCamera, SpansFovFromTopToBottomAndSquarePixels) {
  const auto camera = still(pose_at({0, 0, 5}, {0, 0, 0}), {200, 100});
  const float tangent = std::tan(20.0F * kDegree);
  const auto slope = [&](float x, float y) {
    const Ray ray = camera->generate({x, y}, {0.5F, 0.5F}, 0.0F);
    EXPECT_TRUE(is_unit(ray.direction));
    return Vec2(ray.direction) / -ray.direction.z;
  };
  // Film y runs down and x runs to the right.
  EXPECT_NEAR(slope(100, 0).y, tangent, 1e-5F);
  EXPECT_NEAR(slope(100, 100).y, -tangent, 1e-5F);
  EXPECT_NEAR(slope(0, 50).x, -2 * tangent, 1e-5F);
  EXPECT_NEAR(slope(200, 50).x, 2 * tangent, 1e-5F);
  EXPECT_NEAR(slope(150, 50).x, tangent, 1e-5F);
}

TEST(PerspectiveCamera, IsAffineInFilmCoordinates) {
  // The first pixel's centre is (0.5, 0.5): the slopes of pixel centres must be symmetric.
  const auto camera = still(pose_at({0, 0, 0}, {0, 0, -1}), {4, 4});
  const Ray first = camera->generate({0.5F, 0.5F}, {0, 0}, 0.0F);
  const Ray last = camera->generate({3.5F, 3.5F}, {0, 0}, 0.0F);
  EXPECT_FLOAT_EQ(first.direction.x, -last.direction.x);
  EXPECT_FLOAT_EQ(first.direction.y, -last.direction.y);
  EXPECT_FLOAT_EQ(first.direction.z, last.direction.z);
  const float edge = std::tan(20.0F * kDegree);
  EXPECT_NEAR(first.direction.y / -first.direction.z, 0.75F * edge, 1e-6F);
}

TEST(PerspectiveCamera, LensRaysMeetInThePlaneOfFocus) {
  for (const int blades : {0, 5, 8}) {
    CameraPose pose = pose_at({3, 1, 2}, {0, 0, 0});
    pose.lens_radius = 0.3F;
    pose.focus_distance = 7.0F;
    const auto camera = still(pose, {320, 200}, blades);
    pose.lens_radius = 0.0F;
    const auto pinhole = still(pose, {320, 200}, blades);
    const Vec2 film(37.25F, 181.5F);
    const Ray chief = pinhole->generate(film, {0, 0}, 0.0F);
    const float cosine = glm::dot(chief.direction, glm::normalize(pose.at - pose.from));
    const Vec3 focus = chief.at(7.0F / cosine);
    EXPECT_NEAR(camera->depth_of(focus, 0.0F), 7.0F, 1e-5F);
    float widest = 0.0F;
    for (int i = 0; i < 64; ++i) {
      const Vec2 lens((static_cast<float>(i % 8) + 0.5F) / 8, (static_cast<float>(i / 8)) / 8);
      const Ray ray = camera->generate(film, lens, 0.0F);
      EXPECT_TRUE(is_unit(ray.direction));
      const float offset = glm::length(ray.origin - pose.from);
      EXPECT_LE(offset, 0.3F * 1.0001F);
      EXPECT_NEAR(glm::dot(ray.origin - pose.from, pose.at - pose.from), 0.0F, 1e-5F);
      widest = std::max(widest, offset);
      const Vec3 to_focus = focus - ray.origin;
      expect_close_vectors(glm::normalize(to_focus), ray.direction, 2e-6F);
    }
    EXPECT_GT(widest, 0.2F);
  }
}

TEST(PerspectiveCamera, LensIsUsedUniformly) {
  constexpr int kGrid = 8;
  for (const int blades : {0, 3, 6}) {
    CameraPose pose = pose_at({0, 0, 0}, {0, 0, -1});
    pose.lens_radius = 1.0F;
    const auto camera = make_perspective_camera({pose}, {100, 100}, {blades, 0.3F});
    const auto inside = [&](double x, double y) {
      if (blades < 3) return x * x + y * y < 1.0;
      // Within cos(pi / n) of the centre along the normal of every side.
      for (int side = 0; side < blades; ++side) {
        const double angle = 0.3 + (2.0 * side + 1.0) * M_PI / blades;
        if (x * std::cos(angle) + y * std::sin(angle) > std::cos(M_PI / blades)) return false;
      }
      return true;
    };
    const auto cell = [](double x, double y) {
      const auto index = [](double t) {
        return std::clamp(static_cast<int>((t + 1.0) * 0.5 * kGrid), 0, kGrid - 1);
      };
      return static_cast<size_t>(index(y) * kGrid + index(x));
    };
    std::vector<double> expected(kGrid * kGrid, 0.0);
    constexpr int kFine = 2000;
    double total = 0.0;
    for (int i = 0; i < kFine * kFine; ++i) {
      const double x = 2.0 * (i % kFine + 0.5) / kFine - 1.0;
      const double y = 2.0 * (i / kFine + 0.5) / kFine - 1.0;
      if (!inside(x, y)) continue;
      expected[cell(x, y)] += 1.0;
      total += 1.0;
    }
    const double alpha = test::sidak(0.01, 3);
    const int64_t count = test::required_chi_squared_samples(kGrid * kGrid - 1, 0.01, alpha, 0.99);
    for (double& e : expected) e *= static_cast<double>(count) / total;
    std::vector<double> observed(expected.size(), 0.0);
    test::Random random(3);
    for (int64_t i = 0; i < count; ++i) {
      const Vec3 at = camera->generate({50, 50}, random.uniform2(), 0.0F).origin;
      observed[cell(static_cast<double>(at.x), static_cast<double>(at.y))] += 1.0;
    }
    const auto result = test::chi_squared(observed, expected);
    EXPECT_GT(result.p, alpha) << blades << " blades";
  }
}

TEST(PerspectiveCamera, FocusAtInfinityGivesParallelRays) {
  CameraPose pose = pose_at({0, 0, 0}, {0, 0, -1});
  pose.lens_radius = 0.5F;
  pose.focus_distance = kInfinity;
  const auto camera = still(pose, {100, 100});
  const Ray a = camera->generate({20, 30}, {0.1F, 0.2F}, 0.0F);
  const Ray b = camera->generate({20, 30}, {0.8F, 0.7F}, 0.0F);
  EXPECT_GT(glm::length(a.origin - b.origin), 0.1F);
  expect_close_vectors(a.direction, b.direction, 0.0F);
}

TEST(PerspectiveCamera, MovesThroughItsPosesWithinTheShutter) {
  CameraPose a = pose_at({0, 0, 0}, {0, 0, -1});
  CameraPose b = pose_at({2, 0, 0}, {2, 0, -1});
  CameraPose c = pose_at({2, 4, 0}, {2, 4, -1});
  c.fov = 80.0F * kDegree;
  const auto camera = make_perspective_camera({a, b, c}, {100, 100}, {});
  const auto origin = [&](float time) { return camera->generate({50, 50}, {0, 0}, time).origin; };
  expect_close_vectors(origin(0.0F), {0, 0, 0}, 0.0F);
  expect_close_vectors(origin(0.25F), {1, 0, 0}, 1e-6F);
  expect_close_vectors(origin(0.5F), {2, 0, 0}, 1e-6F);
  expect_close_vectors(origin(0.75F), {2, 2, 0}, 1e-6F);
  expect_close_vectors(origin(1.0F), {2, 4, 0}, 1e-6F);
  const Ray top = camera->generate({50, 0}, {0, 0}, 0.75F);
  EXPECT_NEAR(top.direction.y / -top.direction.z, std::tan(30.0F * kDegree), 1e-5F);
  EXPECT_NEAR(camera->depth_of({1, 7, -3}, 0.3F), 3.0F, 1e-6F);
}

TEST(PerspectiveCamera, FallsBackWhereAPoseSaysTooLittle) {
  CameraPose nowhere = pose_at({1, 1, 1}, {1, 1, 1});
  expect_close_vectors(still(nowhere, {10, 10})->generate({5, 5}, {0, 0}, 0).direction, {0, 0, -1},
                       0.0F);

  // Straight down and up: +x stays on the right.
  for (const float y : {-1.0F, 1.0F}) {
    const auto camera = still(pose_at({0, 0, 0}, {0, y, 0}), {10, 10});
    expect_close_vectors(camera->generate({5, 5}, {0, 0}, 0).direction, {0, y, 0}, 1e-6F);
    EXPECT_GT(camera->generate({9, 5}, {0, 0}, 0).direction.x, 0.1F);
    EXPECT_GT(camera->generate({5, 1}, {0, 0}, 0).direction.z * y, 0.1F);
  }

  CameraPose no_up = pose_at({0, 0, 0}, {0, 0, -1});
  no_up.up = Vec3(0.0F);
  EXPECT_GT(still(no_up, {10, 10})->generate({5, 1}, {0, 0}, 0).direction.y, 0.1F);
  no_up.up = {0, 0, 1};
  EXPECT_GT(still(no_up, {10, 10})->generate({5, 1}, {0, 0}, 0).direction.y, 0.1F);

  CameraPose no_focus = pose_at({0, 0, 0}, {0, 0, -1});
  no_focus.lens_radius = 1.0F;
  no_focus.focus_distance = 0.0F;
  expect_close_vectors(still(no_focus, {10, 10})->generate({5, 5}, {0.9F, 0.9F}, 0).direction,
                       {0, 0, -1}, 0.0F);

  const auto no_pose = make_perspective_camera({}, {0, 0}, {});
  EXPECT_TRUE(is_unit(no_pose->generate({0.5F, 0.5F}, {0.5F, 0.5F}, 0.5F).direction));
}

TEST(PerspectiveCamera, WorksAtVeryLargeAndSmallScales) {
  for (const float scale : {1e-20F, 1e-3F, 1e6F, 1e18F}) {
    const auto camera = still(pose_at(Vec3(0, 0, 2) * scale, Vec3(0, 0, 0)), {10, 10});
    expect_close_vectors(camera->generate({5, 5}, {0, 0}, 0).direction, {0, 0, -1}, 1e-6F);
    EXPECT_TRUE(is_unit(camera->generate({1, 2}, {0, 0}, 0).direction));
  }
}

// The area that a pixel covers of a wall seen from anywhere is that between the rays of its
// corners.
TEST(PerspectiveCamera, PixelsAreAsWideAsTheirRaysAreApart) {
  CameraPose pose = pose_at({1, 2, 3}, {0, 0, 0});
  pose.fov = 70.0F * kDegree;
  const auto camera = still(pose, {640, 480});
  for (const Vec2 film : {Vec2(320, 240), Vec2(1, 1), Vec2(600, 100), Vec2(320, 470)}) {
    const auto at = [&](float dx, float dy) {
      return camera->generate(film + Vec2(dx, dy), {0.5F, 0.5F}, 0.0F).direction;
    };
    const Vec3 point = Vec3(1, 2, 3) + 5.0F * at(0, 0);
    const PixelCone cone = camera->pixel_at(point, 0.0F);
    expect_close_vectors(cone.direction, at(0, 0), 1e-5F);
    const Vec3 area = 25.0F * glm::cross(at(0.5F, 0) - at(-0.5F, 0), at(0, 0.5F) - at(0, -0.5F));
    EXPECT_NEAR(cone.width, std::sqrt(glm::length(area)), 1e-3F * cone.width);
  }
}

// Behind the camera and beside the picture the distance counts alone, without a jump at the edge.
TEST(PerspectiveCamera, PixelsOutsideOfThePictureAreThoseOfItsCorners) {
  const auto camera = still(pose_at({0, 0, 0}, {0, 0, -1}), {640, 480});
  const float corner =
      camera->pixel_at(camera->generate({0, 0}, {0, 0}, 0.0F).direction, 0.0F).width;
  EXPECT_NEAR(camera->pixel_at({0, 0, 1}, 0.0F).width, corner, 1e-5F * corner);
  EXPECT_NEAR(camera->pixel_at({7, 0, 0}, 0.0F).width, 7.0F * corner, 1e-5F * corner);
  EXPECT_EQ(camera->pixel_at({0, 0, 0}, 0.0F).width, 0.0F);
}

}  // namespace
}  // namespace hyades::core
