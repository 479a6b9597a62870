#include "core/lights/light_bounds.h"

#include <gtest/gtest.h>

#include "core/base/elementary.h"
#include "core/base/warp.h"
#include "tests/core/lights/lamp.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

TEST(DirectionCone, HoldsBothThatWereJoined) {
  test::Random random(3);
  for (int i = 0; i < 2000; ++i) {
    DirectionCone cones[2];
    for (DirectionCone& cone : cones) {
      cone.axis = square_to_uniform_sphere(random.uniform2());
      cone.cosine = cos(random.uniform() * (i % 2 == 0 ? 0.5F : 2.5F));
    }
    if (i % 5 == 0) cones[1].axis = i % 10 == 0 ? cones[0].axis : -cones[0].axis;
    const DirectionCone both = join(cones[0], cones[1]);
    EXPECT_NEAR(glm::length(both.axis), 1.0F, 1e-5F);
    for (const DirectionCone& cone : cones) {
      const Frame frame = Frame::around(cone.axis);
      for (int k = 0; k < 16; ++k) {
        const Vec3 local = square_to_cone({random.uniform(), k < 8 ? 1.0F : random.uniform()},
                                          std::max(1.0F - cone.cosine, 0.0F));
        EXPECT_GE(glm::dot(frame.to_world(local), both.axis), both.cosine - 1e-5F) << i;
      }
    }
  }
}

TEST(DirectionCone, OfEqualConesStaysNearlyTheSame) {
  const DirectionCone up{{0, 1, 0}, 1.0F};
  DirectionCone all = up;
  for (int i = 0; i < 100; ++i) all = join(all, up);
  EXPECT_GT(all.cosine, 0.99999F);
}

LightBounds shining(float spread, float beyond, bool two_sided = false) {
  LightBounds bounds;
  bounds.normals.cosine = cos(spread);
  bounds.cos_beyond = cos(beyond);
  bounds.two_sided = two_sided;
  return bounds;
}

/// Flux over intensity, as known for each.
TEST(OrientationMeasure, IsTheSolidAngleThatLightGoesInto) {
  EXPECT_NEAR(orientation_measure(shining(0.0F, 0.5F * kPi)), kPi, 1e-4F);  // a flat lamp
  EXPECT_NEAR(orientation_measure(shining(0.0F, 0.5F * kPi, true)), 2.0F * kPi, 1e-4F);
  EXPECT_NEAR(orientation_measure(shining(kPi, 0.5F * kPi)), 4.0F * kPi, 1e-4F);  // a ball
  EXPECT_NEAR(orientation_measure(shining(0.7F, 0.0F)), 2.0F * kPi * (1.0F - cos(0.7F)), 1e-4F);
}

/// Light leaves from within the box, in directions that the cone allows.
void expect_bounded(const Light& light) {
  const auto bounds = light.bounds();
  ASSERT_TRUE(bounds);
  EXPECT_FLOAT_EQ(bounds->power, light.power());
  test::Random random(11);
  const float beyond = acos(bounds->cos_beyond) + acos(bounds->normals.cosine) + 1e-3F;
  const float slack = 1e-5F * (1.0F + max_component(glm::abs(bounds->box.center())));
  for (int i = 0; i < 2000; ++i) {
    const auto s = light.sample_emission(random.uniform(), random.uniform(), random.uniform2(),
                                         random.uniform2());
    if (!s) continue;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(s->on.position[axis], bounds->box.lower[axis] - slack);
      EXPECT_LE(s->on.position[axis], bounds->box.upper[axis] + slack);
    }
    float cosine = glm::dot(s->direction, bounds->normals.axis);
    if (bounds->two_sided) cosine = std::abs(cosine);
    EXPECT_LE(acos(cosine), beyond);
  }
}

std::shared_ptr<TriangleMesh> roof() {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = {{-1, 0, -1}, {-1, 0, 1}, {0, 1, -1}, {0, 1, 1}, {1, 0, -1}, {1, 0, 1}};
  mesh->triangles = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}};
  finish_mesh(*mesh);
  return mesh;
}

TEST(LightBounds, HoldAllThatLightsGiveOff) {
  const std::vector<Mat4> turning = {skewed(),
                                     skewed() * glm::rotate(Mat4(1.0F), 1.0F, Vec3(1, 0, 0)),
                                     skewed() * glm::rotate(Mat4(1.0F), 2.0F, Vec3(1, 0, 0))};
  const std::vector<Mat4> going = {moved({0, 0, 0}), moved({3, 1, -2})};
  for (const bool two_sided : {false, true}) {
    for (const auto& motion : {std::vector<Mat4>{skewed()}, going, turning}) {
      for (const Shape& shape :
           {quadric(Shape::Kind::sphere, 0.7F), quadric(Shape::Kind::disk, 1.5F),
            quadric(Shape::Kind::cylinder, 0.2F, 2.0F), mesh(roof())}) {
        expect_bounded(*Lamp(shape, motion, two_sided).light);
      }
    }
  }
  expect_bounded(*make_point_light({1, 2, 3}, Rgb(4.0F)));
  expect_bounded(*make_spot_light({1, 2, 3}, {0, 0, 1}, Rgb(4.0F), 0.9F, 0.4F));
  expect_bounded(*make_spot_light({1, 2, 3}, {0, 0, 1}, Rgb(4.0F), 0.2F, -0.6F));
  const auto white = std::make_shared<const Image>(Image{2, 1, {"Y"}, {1.0F, 1.0F}});
  expect_bounded(*make_projector_light({1, 2, 3}, Mat3(1.0F), Rgb(4.0F), 1.0F,
                                       std::make_shared<const Gobo>(white)));
  expect_bounded(*make_goniometric_light({1, 2, 3}, Mat3(1.0F), Rgb(4.0F),
                                         std::make_shared<const EnvironmentMap>(white)));
}

TEST(LightBounds, OfFlatLampsAreNarrow) {
  const auto disk = Lamp(quadric(Shape::Kind::disk, 1.0F), {Mat4(1.0F)}).light->bounds();
  EXPECT_GT(disk->normals.cosine, 0.9999F);
  EXPECT_NEAR(disk->intensity, luminance(kRadiance) * kPi, 1e-3F);
  const auto slopes = Lamp(mesh(roof()), {Mat4(1.0F)}).light->bounds();
  EXPECT_NEAR(slopes->normals.cosine, std::sqrt(0.5F), 1e-3F);
}

TEST(LightBounds, AreNoneWhereThereIsNoLight) {
  EXPECT_FALSE(make_point_light({}, Rgb(0.0F))->bounds());
  EXPECT_FALSE(make_environment_light(nullptr, 0.0F, Rgb(1.0F), 1.0F)->bounds());
  EXPECT_FALSE(make_sun_light({0, -1, 0}, Rgb(1.0F), 0.01F, 1.0F)->bounds());
}

}  // namespace
}  // namespace hyades::core
