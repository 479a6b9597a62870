#include "core/geometry/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/elementary.h"
#include "tests/support/tested_class.h"

namespace hyades::core {
namespace {

std::shared_ptr<const World> world_of(std::vector<Placement> placements) {
  GeometryCache cache;
  auto world = build_world(std::move(placements), cache, test::tested_class());
  EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().message);
  return world.ok() ? *world : nullptr;
}

Placement mesh_placement(std::shared_ptr<const TriangleMesh> mesh, const Mat4& m = Mat4(1.0F)) {
  Placement p;
  p.shape.mesh = std::move(mesh);
  p.to_world = {m};
  return p;
}

Placement quadric_placement(Shape::Kind kind, float radius, float height = 1.0F) {
  Placement p;
  p.shape.kind = kind;
  p.shape.radius = radius;
  p.shape.height = height;
  return p;
}

TEST(World, EmptyWorldIsMissed) {
  const auto world = world_of({});
  EXPECT_FALSE(world->intersect({}, RayKind::camera));
  EXPECT_FALSE(world->occluded({}));
  EXPECT_TRUE(world->bounds().empty());
  EXPECT_EQ(world->placement_count(), 0U);
}

TEST(World, RectangleIsHitWhereItIs) {
  const auto world = world_of({mesh_placement(make_rectangle({2, 4}))});
  const Ray ray{{0.25F, 3.0F, -1.0F}, {0.0F, -1.0F, 0.0F}};
  const auto hit = world->intersect(ray, RayKind::camera);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, 3.0F);
  const SurfacePoint p = world->surface(ray, *hit);
  EXPECT_EQ(p.position, Vec3(0.25F, 0.0F, -1.0F));
  EXPECT_EQ(p.ng, Vec3(0, 1, 0));
  EXPECT_FLOAT_EQ(p.uv.x, 0.625F);
  EXPECT_FLOAT_EQ(p.uv.y, 0.75F);
  EXPECT_EQ(p.dpdu, Vec3(2, 0, 0));
  EXPECT_EQ(p.dpdv, Vec3(0, 0, -4));
  EXPECT_TRUE(world->occluded(ray));
  Ray shorter = ray;
  shorter.t_max = 2.9F;
  EXPECT_FALSE(world->occluded(shorter));
  EXPECT_FALSE(world->intersect(shorter, RayKind::camera));
}

TEST(World, SphereIsHitFromOutsideAndInside) {
  const auto world = world_of({quadric_placement(Shape::Kind::sphere, 2.0F)});
  const Ray outside{{5, 0, 0}, {-1, 0, 0}};
  auto hit = world->intersect(outside, RayKind::camera);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, 3.0F);
  SurfacePoint p = world->surface(outside, *hit);
  EXPECT_EQ(p.position, Vec3(2, 0, 0));
  EXPECT_EQ(p.ng, Vec3(1, 0, 0));
  EXPECT_FLOAT_EQ(p.uv.y, 0.5F);
  const Ray inside{{0, 0, 0}, {0, 1, 0}};
  hit = world->intersect(inside, RayKind::camera);
  ASSERT_TRUE(hit);
  p = world->surface(inside, *hit);
  EXPECT_EQ(p.position, Vec3(0, 2, 0));
  EXPECT_EQ(p.ng, Vec3(0, 1, 0));
  EXPECT_FLOAT_EQ(p.uv.y, 1.0F);
}

TEST(World, CameraRaysPassInvisiblePlacements) {
  Placement sphere = quadric_placement(Shape::Kind::sphere, 1.0F);
  sphere.seen_by = RayKind::scattered | RayKind::shadow;
  Placement rectangle = mesh_placement(make_rectangle({2, 2}), Mat4(1.0F));
  rectangle.seen_by = RayKind::scattered | RayKind::shadow;
  const auto world = world_of({sphere, rectangle});
  const Ray ray{{0, 5, 0}, {0, -1, 0}};
  EXPECT_FALSE(world->intersect(ray, RayKind::camera));
  const auto hit = world->intersect(ray, RayKind::diffuse);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->object, 0U);
  EXPECT_TRUE(world->occluded(ray));
}

/// Each kind of ray sees what has its bit, and sets of kinds what has one of theirs; instances too.
TEST(World, EachKindOfRayMeetsItsOwn) {
  const RayKind kinds[] = {RayKind::camera,       RayKind::diffuse, RayKind::glossy,
                           RayKind::transmission, RayKind::volume,  RayKind::shadow};
  const Ray ray{{0.1F, 5, 0.2F}, {0, -1, 0}};
  for (const RayKind hidden_from : kinds) {
    for (const bool mesh : {false, true}) {
      Placement p = mesh ? mesh_placement(make_rectangle({2, 2}))
                         : quadric_placement(Shape::Kind::sphere, 1.0F);
      p.seen_by = RayKind::none;
      for (const RayKind kind : kinds) {
        if (kind != hidden_from) p.seen_by = p.seen_by | kind;
      }
      const auto world = world_of({p});
      for (const RayKind kind : kinds)
        EXPECT_EQ(world->intersect(ray, kind).has_value(), kind != hidden_from);
      EXPECT_TRUE(world->intersect(ray, hidden_from | kinds[hidden_from == kinds[0] ? 1 : 0]));
      EXPECT_EQ(world->occluded(ray), hidden_from != RayKind::shadow);
    }
  }
}

TEST(World, ShadowsPassWhatBlocksNoLight) {
  for (const bool mesh : {false, true}) {
    Placement p = mesh ? mesh_placement(make_rectangle({2, 2}))
                       : quadric_placement(Shape::Kind::sphere, 1.0F);
    p.blocks_light = false;
    const auto world = world_of({p});
    const Ray ray{{0.1F, 5, 0.2F}, {0, -1, 0}};
    EXPECT_TRUE(world->intersect(ray, RayKind::camera));
    EXPECT_TRUE(world->intersect(ray, RayKind::diffuse));
    EXPECT_FALSE(world->occluded(ray));
  }
}

TEST(World, NonFiniteRaysAreCountedAndMiss) {
  const auto world = world_of({quadric_placement(Shape::Kind::sphere, 1.0F)});
  const float nan = std::nanf("");
  std::vector<Ray> bad(8, Ray{{0, 0, 0}, {0, 0, 1}});
  bad[0].origin.x = nan;
  bad[1].direction.y = nan;
  bad[2].t_max = nan;
  bad[3].time = nan;
  bad[4].origin.z = kInfinity;
  bad[5].direction.z = kInfinity;
  bad[6].direction = Vec3(0.0F);
  bad[7].origin.x = 3e38F;
  for (const Ray& ray : bad) {
    EXPECT_FALSE(world->intersect(ray, RayKind::diffuse));
    EXPECT_FALSE(world->occluded(ray));
  }
  EXPECT_EQ(world->invalid_rays(), 16U);
}

}  // namespace
}  // namespace hyades::core
