// Meshes that deform while the shutter is open: what rays find is the mesh of their moment.
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/fp_mode.h"
#include "core/geometry/mesh_buffers.h"
#include "core/geometry/surface_point.h"
#include "tests/core/geometry/test_worlds.h"

namespace hyades::core {
namespace {

using test::Random;

/// `mesh` with its vertices moved by at most `by`, and smooth normals.
std::shared_ptr<TriangleMesh> stirred(const TriangleMesh& mesh, float by, uint64_t seed) {
  auto out = std::make_shared<TriangleMesh>(mesh);
  Random random(seed);
  for (Vec3& p : out->positions) p += by * random.direction();
  compute_smooth_normals(*out);
  finish_mesh(*out);
  return out;
}

/// The mesh that `shape` is at `time`.
std::shared_ptr<TriangleMesh> frozen(const Shape& shape, float time) {
  auto out = std::make_shared<TriangleMesh>(*shape.mesh);
  const float f = time * shape.reach;
  for (size_t i = 0; i < out->positions.size(); ++i) {
    out->positions[i] = (1.0F - f) * shape.mesh->positions[i] + f * shape.next->positions[i];
    out->normals[i] = (1.0F - f) * shape.mesh->normals[i] + f * shape.next->normals[i];
  }
  finish_mesh(*out);
  return out;
}

Placement deforming(float reach, std::vector<Mat4> to_world = {Mat4(1.0F)}) {
  const auto ball = test::make_ball(2);
  Placement p = test::place(stirred(*ball, 0.02F, 1), std::move(to_world));
  p.shape.next = stirred(*ball, 0.3F, 2);
  p.shape.reach = reach;
  p.changes_between_frames = true;
  return p;
}

Ray some_ray(Random& random, float time) {
  Ray ray;
  ray.origin = 4.0F * random.direction();
  ray.direction = glm::normalize(0.8F * random.direction() - ray.origin);
  ray.time = time;
  return ray;
}

/// Rays at `time` find in `world` what they find in a world of the mesh of that moment.
void expect_moment(const World& world, const Placement& placement, float time, const Mat4& to_world,
                   float tolerance = 2e-4F) {
  Placement still = placement;
  still.shape.mesh = frozen(placement.shape, time);
  still.shape.next = nullptr;
  still.to_world = {to_world};
  const auto expected = test::build({still});
  Random random(7);
  int met = 0;
  for (int i = 0; i < 4000; ++i) {
    const Ray ray = some_ray(random, time);
    SurfacePoint a;
    SurfacePoint b;
    const bool found = world.nearest(ray, RayKind::diffuse, a);
    ASSERT_EQ(world.occluded(ray), found);
    if (found != expected->nearest(ray, RayKind::diffuse, b)) continue;  // past an edge
    if (!found || a.primitive != b.primitive) continue;
    ++met;
    ASSERT_NEAR(a.t, b.t, tolerance);
    ASSERT_LT(glm::length(a.position - b.position), tolerance);
    ASSERT_GT(glm::dot(a.ng, b.ng), 0.9999F);
    ASSERT_GT(glm::dot(a.ns, b.ns), 0.9999F);
  }
  EXPECT_GT(met, 1000);
}

Mat4 shear() {
  Mat4 m = test::translation({0.1F, -0.2F, 0.05F});
  m[1].x = 0.4F;
  return m;
}

TEST(Deforming, RaysFindTheMeshOfTheirMoment) {
  const FpMode mode;
  for (const float reach : {1.0F, 0.4F}) {
    for (const auto& thresholds : {BuildThresholds(), test::kInstanceAll}) {
      for (const Mat4& m : {Mat4(1.0F), shear()}) {
        const Placement p = deforming(reach, {m});
        Placement far = p;
        far.to_world = {test::translation({30.0F, 0.0F, 0.0F})};
        const auto world = test::build({p, far}, thresholds);
        for (const float time : {0.0F, 0.3F, 0.71F, 1.0F}) expect_moment(*world, p, time, m);
      }
    }
  }
}

TEST(Deforming, UnderAMovingMatrixToo) {
  const FpMode mode;
  const std::vector<Mat4> steps = {Mat4(1.0F), shear()};
  const Placement p = deforming(0.8F, steps);
  const auto world = test::build({p});
  for (const float time : {0.0F, 0.25F, 0.5F, 0.9F}) {
    expect_moment(*world, p, time, steps[0] * (1.0F - time) + steps[1] * time);
  }
}

TEST(Deforming, WhereNoInstanceCanFollowVerticesTakeManyStraightWays) {
  const FpMode mode;
  Mat4 half_turn = test::scaling({-1.0F, 1.0F, -1.0F});
  const Placement p = deforming(1.0F, {Mat4(1.0F), half_turn});
  const Motion motion(p.to_world);
  const auto buffers = make_mesh_buffers(p.shape, &motion);
  EXPECT_EQ(buffers->steps.size(), 33U);
  const auto world = test::build({p});
  for (const float time : {0.0F, 0.3F, 0.8F, 1.0F}) {
    expect_moment(*world, p, time, Mat4(1.0F) * (1.0F - time) + half_turn * time, 5e-3F);
  }
}

TEST(Deforming, AMeshThatIsCarriedAlongIsAMeshThatMoves) {
  const FpMode mode;
  const Vec3 way(1.5F, 0.5F, -0.25F);
  const auto ball = stirred(*test::make_ball(3), 0.0F, 1);
  const auto moved = std::make_shared<TriangleMesh>(*ball);
  for (Vec3& p : moved->positions) p += way;
  finish_mesh(*moved);
  Placement deforms = test::place(ball);
  deforms.shape.next = moved;
  const auto a = test::build({deforms});
  const auto b = test::build({test::place(ball, {Mat4(1.0F), test::translation(way)})});
  Random random(3);
  int met = 0;
  for (int i = 0; i < 20'000; ++i) {
    Ray ray = some_ray(random, random.uniform());
    ray.direction = glm::normalize(0.9F * random.direction() + way * ray.time - ray.origin);
    SurfacePoint p;
    SurfacePoint q;
    const bool found = a->nearest(ray, RayKind::diffuse, p);
    if (found != b->nearest(ray, RayKind::diffuse, q) || !found) continue;
    ++met;
    ASSERT_NEAR(p.t, q.t, 1e-4F);
    ASSERT_GT(glm::dot(p.ns, q.ns), 0.9999F);
  }
  EXPECT_GT(met, 15'000);
}

TEST(Deforming, RaysLeaveTheirSurface) {
  const FpMode mode;
  Placement p = deforming(1.0F);
  p.shape.mesh = stirred(*test::make_ball(3), 0.0F, 1);  // closed and convex at both ends
  auto large = std::make_shared<TriangleMesh>(*p.shape.mesh);
  for (Vec3& v : large->positions) v *= 1.7F;
  finish_mesh(*large);
  p.shape.next = large;
  for (const std::vector<Mat4>& m :
       {std::vector<Mat4>{Mat4(1.0F)}, {Mat4(1.0F), test::translation({0.5F, 0.1F, 0.2F})}}) {
    p.to_world = m;
    const auto world = test::build({p});
    Random random(11);
    int met = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Ray ray = some_ray(random, random.uniform());
      SurfacePoint on;
      if (!world->nearest(ray, RayKind::diffuse, on)) continue;
      ++met;
      Vec3 out = random.direction();
      if (glm::dot(out, on.ng) < 0.0F) out = -out;
      ASSERT_FALSE(world->occluded(spawn_ray(on, out))) << i;
      ASSERT_TRUE(world->occluded(spawn_ray(on, -out))) << i;
    }
    EXPECT_GT(met, 10'000);
  }
}

TEST(Deforming, LightsSampleTheMeshOfTheirMoment) {
  const FpMode mode;
  const Placement p = deforming(0.5F);
  const auto world = test::build({p});
  for (const float time : {0.0F, 0.6F, 1.0F}) {
    const auto mesh = frozen(p.shape, time);
    for (uint32_t i = 0; i < 20; ++i) {
      const auto& t = mesh->triangles[i];
      const SurfacePoint on = world->triangle_point(0, i, 0.25F, 0.5F, time);
      const Vec3 expected = 0.25F * mesh->positions[t[0]] + 0.25F * mesh->positions[t[1]] +
                            0.5F * mesh->positions[t[2]];
      EXPECT_LT(glm::length(on.position - expected), 1e-6F);
    }
  }
}

TEST(Deforming, TrianglesThatOpenBetweenTwoFlatOnesAreMet) {
  const FpMode mode;
  // Flat along x, then flat along y; a triangle of half the size in between.
  auto a = std::make_shared<TriangleMesh>();
  a->positions = {{0, 0, 0}, {2, 0, 0}, {0, 0, 0}};
  a->triangles = {{0, 1, 2}};
  finish_mesh(*a);
  auto b = std::make_shared<TriangleMesh>(*a);
  b->positions = {{0, 0, 0}, {0, 0, 0}, {0, 2, 0}};
  finish_mesh(*b);
  Placement p = test::place(a);
  p.shape.next = b;
  const auto world = test::build({p});
  Ray ray{{0.3F, 0.3F, 1.0F}, {0.0F, 0.0F, -1.0F}, kInfinity, 0.5F};
  EXPECT_TRUE(world->intersect(ray, RayKind::diffuse));
  ray.time = 0.0F;
  EXPECT_FALSE(world->intersect(ray, RayKind::diffuse));
  b->positions[2] = {0, 0, 0};
  const auto flat = test::build({p});
  ray.time = 0.5F;
  EXPECT_FALSE(flat->intersect(ray, RayKind::diffuse));
}

TEST(Deforming, BoundsHoldAllMoments) {
  const Placement p = deforming(1.0F);
  Bounds both = p.shape.mesh->bounds;
  both.include(p.shape.next->bounds);
  const Bounds world = test::build({p})->bounds();
  for (int i = 0; i < 3; ++i) {
    EXPECT_LE(world.lower[i], both.lower[i]);
    EXPECT_GE(world.upper[i], both.upper[i]);
  }
}

TEST(Deforming, MeshesOfOtherVerticesAreRefused) {
  Placement p = deforming(1.0F);
  p.shape.next = stirred(*test::make_ball(1), 0.0F, 1);
  EXPECT_FALSE(same_topology(*p.shape.mesh, *p.shape.next));
  GeometryCache cache;
  const auto world = build_world({p}, cache, test::tested_class());
  ASSERT_FALSE(world.ok());
  EXPECT_NE(world.error().message.find("other vertices"), std::string::npos);
}

}  // namespace
}  // namespace hyades::core
