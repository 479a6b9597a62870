// What World::surface says about a point: normals, UVs, tangents, matrices.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/core/geometry/test_worlds.h"

namespace hyades::core {
namespace {

using test::Random;

/// A ball with smooth normals and made-up UVs u = (x + 2 y) / 4, v = (z - x) / 3: affine in space,
/// so dpdu and dpdv on a facet are known.
std::shared_ptr<TriangleMesh> textured_ball() {
  auto mesh = test::make_ball(3);
  for (const Vec3& p : mesh->positions) {
    mesh->normals.push_back(glm::normalize(p));
    mesh->uvs.emplace_back((p.x + 2.0F * p.y) / 4.0F, (p.z - p.x) / 3.0F);
  }
  return mesh;
}

std::vector<Mat4> transforms(Random& random, bool mirrored) {
  const Mat4 m = test::translation({3, -1, 2}) * test::random_rotation(random) *
                 test::scaling({mirrored ? -0.5F : 0.5F, 2.0F, 1.2F});
  return {m, test::translation({0.2F, 0.1F, 0.0F}) * m};
}

/// The point hit by a ray at the centre of the object from a random side.
std::optional<SurfacePoint> random_point(const World& world, Random& random, Ray& ray) {
  const Bounds b = world.bounds();
  const Vec3 from = b.center() + 2.0F * glm::length(b.size()) * random.direction();
  ray = {from, glm::normalize(b.center() - from)};
  ray.time = random.uniform();
  const auto hit = world.intersect(ray, RayKind::camera);
  if (!hit) return std::nullopt;
  return world.surface(ray, *hit);
}

/// Direct, instanced and moving; mirrored or not.
std::vector<std::vector<Placement>> ways(const Placement& p, Random& random) {
  std::vector<std::vector<Placement>> out;
  for (const bool mirrored : {false, true}) {
    const auto steps = transforms(random, mirrored);
    Placement still = p;
    still.to_world = {steps[0]};
    Placement instance = still;
    instance.changes_between_frames = true;
    Placement moving = p;
    moving.to_world = steps;
    for (const Placement& way : {still, instance, moving}) out.push_back({way});
  }
  return out;
}

TEST(Surface, MeshPointsAgreeWithTheirDefinition) {
  Random random(1);
  const auto mesh = textured_ball();
  for (const auto& placements : ways(test::place(mesh), random)) {
    const auto world = test::build(placements, test::kInstanceAll);
    for (int i = 0; i < 300; ++i) {
      Ray ray;
      const auto p = random_point(*world, random, ray);
      ASSERT_TRUE(p);
      const Mat4 m = world->transform_at(0, ray.time);
      const glm::dmat4 inverse = glm::inverse(glm::dmat4(m));
      for (int k = 0; k < 4; ++k) {
        EXPECT_LT(glm::length(glm::dvec4(p->world_to_object[k]) - inverse[k]), 2e-6 * 10);
      }
      // The ball is convex around the centre of the world's bounds: outward is against the ray.
      EXPECT_LT(glm::dot(p->ng, ray.direction), 0.0F);
      EXPECT_GT(glm::dot(p->ng, p->ns), 0.9F);
      EXPECT_NEAR(glm::length(p->ng), 1.0F, 1e-6F);
      EXPECT_NEAR(glm::length(p->ns), 1.0F, 1e-6F);
      const Vec3 o = transform_point(p->world_to_object, p->position);
      EXPECT_LT(std::abs(glm::length(o) - 1.0F), 0.02F);
      // The interpolated normal, transformed as planes are: by the inverse transpose.
      const Vec3 ns = glm::normalize(Mat3(glm::transpose(glm::dmat3(inverse))) * glm::normalize(o));
      EXPECT_LT(glm::length(ns - p->ns), 0.02F);
      EXPECT_NEAR(p->uv.x, (o.x + 2.0F * o.y) / 4.0F, 2e-6F);
      EXPECT_NEAR(p->uv.y, (o.z - o.x) / 3.0F, 2e-6F);
      // dpdu is the tangent along which u grows by one and v stays.
      const Vec3 du = transform_vector(p->world_to_object, p->dpdu);
      const Vec3 dv = transform_vector(p->world_to_object, p->dpdv);
      EXPECT_NEAR((du.x + 2.0F * du.y) / 4.0F, 1.0F, 1e-3F);
      EXPECT_NEAR((du.z - du.x) / 3.0F, 0.0F, 1e-3F);
      EXPECT_NEAR((dv.x + 2.0F * dv.y) / 4.0F, 0.0F, 1e-3F);
      EXPECT_NEAR((dv.z - dv.x) / 3.0F, 1.0F, 1e-3F);
      EXPECT_LT(std::abs(glm::dot(p->ng, glm::normalize(p->dpdu))), 1e-4F);
      EXPECT_EQ(p->time, ray.time);
    }
  }
}

TEST(Surface, QuadricPointsAgreeWithTheirDefinition) {
  Random random(2);
  for (const auto kind : {Shape::Kind::sphere, Shape::Kind::disk, Shape::Kind::cylinder}) {
    for (const auto& placements : ways(test::place(kind, 1.5F, 2.0F), random)) {
      const auto world = test::build(placements, test::kInstanceAll);
      size_t found = 0;
      for (int i = 0; i < 300; ++i) {
        Ray ray;
        const auto p = random_point(*world, random, ray);
        if (!p) continue;
        ++found;
        const glm::dvec3 o(transform_point(p->world_to_object, p->position));
        const double turn = static_cast<double>(p->uv.x) * 6.283185307179586;
        const double v = static_cast<double>(p->uv.y);
        glm::dvec3 expected;
        glm::dvec3 normal;
        if (kind == Shape::Kind::sphere) {
          const double polar = v * 3.141592653589793;
          normal = {std::sin(polar) * std::cos(turn), -std::cos(polar),
                    -std::sin(polar) * std::sin(turn)};
          expected = 1.5 * normal;
        } else if (kind == Shape::Kind::disk) {
          expected = 1.5 * v * glm::dvec3(std::cos(turn), 0.0, -std::sin(turn));
          normal = {0.0, 1.0, 0.0};
        } else {
          normal = {std::cos(turn), 0.0, -std::sin(turn)};
          expected = 1.5 * normal + glm::dvec3(0.0, 2.0 * v, 0.0);
        }
        EXPECT_LT(glm::length(o - expected), 2e-5);
        const glm::dmat3 to_object(glm::dmat4(p->world_to_object));
        const glm::dvec3 world_normal = glm::normalize(glm::transpose(to_object) * normal);
        EXPECT_LT(glm::length(glm::dvec3(p->ng) - world_normal), 2e-5);
        EXPECT_EQ(p->ns, p->ng);
        EXPECT_LT(std::abs(glm::dot(p->ng, glm::normalize(p->dpdu))), 1e-5F);
        EXPECT_LT(std::abs(glm::dot(p->ng, glm::normalize(p->dpdv))), 1e-5F);
      }
      EXPECT_GT(found, 100U);
    }
  }
}

TEST(Surface, QuadricTangentsAreDerivatives) {
  // A step of h in u or v from one point to another, against dpdu and dpdv.
  const double h = 1e-3;
  for (const auto kind : {Shape::Kind::sphere, Shape::Kind::disk, Shape::Kind::cylinder}) {
    const auto world = test::build({test::place(kind, 1.5F, 2.0F)});
    const auto at = [&](double u, double v) {
      const double c = std::cos(6.283185307179586 * u);
      const double s = -std::sin(6.283185307179586 * u);
      if (kind == Shape::Kind::disk) return 1.5 * v * glm::dvec3(c, 0.0, s);
      if (kind == Shape::Kind::cylinder) return glm::dvec3(1.5 * c, 2.0 * v, 1.5 * s);
      const double polar = 3.141592653589793 * v;
      return 1.5 * glm::dvec3(std::sin(polar) * c, -std::cos(polar), std::sin(polar) * s);
    };
    for (const double u : {0.1, 0.4, 0.6, 0.9}) {
      for (const double v : {0.2, 0.5, 0.8}) {
        const Vec3 target(at(u, v));
        const Vec3 from = kind == Shape::Kind::disk ? target + Vec3(0.3F, 3.0F, 0.2F)
                                                    : target * Vec3(4.0F, 1.0F, 4.0F);
        const Ray ray{from, glm::normalize(target - from)};
        const auto hit = world->intersect(ray, RayKind::camera);
        ASSERT_TRUE(hit);
        const SurfacePoint p = world->surface(ray, *hit);
        const glm::dvec3 du = (at(u + h, v) - at(u - h, v)) / (2.0 * h);
        const glm::dvec3 dv = (at(u, v + h) - at(u, v - h)) / (2.0 * h);
        EXPECT_LT(glm::length(glm::dvec3(p.dpdu) - du), 1e-3);
        EXPECT_LT(glm::length(glm::dvec3(p.dpdv) - dv), 1e-3);
      }
    }
  }
}

TEST(Surface, NearestIsIntersectAndSurfaceToTheBit) {
  Random random(5);
  for (const auto& shape : {test::place(textured_ball()), test::place(test::make_ball(2)),
                            test::place(Shape::Kind::cylinder, 1.5F, 2.0F)}) {
    for (const auto& placements : ways(shape, random)) {
      const auto world = test::build(placements, test::kInstanceAll);
      const Bounds b = world->bounds();
      int found = 0;
      for (int i = 0; i < 300; ++i) {
        Ray ray{test::in_box(random, b.lower, b.upper), random.direction()};
        ray.time = random.uniform();
        SurfacePoint p;
        const auto hit = world->intersect(ray, RayKind::diffuse);
        ASSERT_EQ(world->nearest(ray, RayKind::diffuse, p), hit.has_value());
        if (!hit) continue;
        ++found;
        const SurfacePoint q = world->surface(ray, *hit);
        EXPECT_EQ(p.position, q.position);
        EXPECT_EQ(p.ng, q.ng);
        EXPECT_EQ(p.ns, q.ns);
        EXPECT_EQ(p.dpdu, q.dpdu);
        EXPECT_EQ(p.dpdv, q.dpdv);
        EXPECT_EQ(p.uv, q.uv);
        EXPECT_EQ(p.t, q.t);
        EXPECT_EQ(p.time, q.time);
        EXPECT_EQ(p.clearance, q.clearance);
        EXPECT_EQ(p.object, q.object);
        EXPECT_EQ(p.primitive, q.primitive);
        EXPECT_EQ(p.world_to_object, q.world_to_object);
      }
      EXPECT_GT(found, 30);
    }
  }
}

TEST(Surface, TrianglePointIsWhereTheRayHits) {
  Random random(3);
  for (const auto& placements : ways(test::place(textured_ball()), random)) {
    const auto world = test::build(placements, test::kInstanceAll);
    for (int i = 0; i < 100; ++i) {
      Ray ray;
      const auto p = random_point(*world, random, ray);
      ASSERT_TRUE(p);
      const auto hit = world->intersect(ray, RayKind::camera);
      const SurfacePoint q =
          world->triangle_point(p->object, p->primitive, hit->u, hit->v, ray.time);
      EXPECT_EQ(p->position, q.position);
      EXPECT_EQ(p->ng, q.ng);
      EXPECT_EQ(p->ns, q.ns);
      EXPECT_EQ(p->uv, q.uv);
      EXPECT_EQ(p->clearance, q.clearance);
    }
  }
}

TEST(Surface, MirroringKeepsOutwardNormalsOutward) {
  const auto world =
      test::build({test::place(make_box({1, 1, 1}), {test::scaling({-1.0F, 1.0F, 1.0F})})});
  const Ray ray{{5.0F, 0.1F, 0.1F}, {-1.0F, 0.0F, 0.0F}};
  const auto hit = world->intersect(ray, RayKind::camera);
  ASSERT_TRUE(hit);
  EXPECT_EQ(world->surface(ray, *hit).ng, Vec3(1, 0, 0));
}

TEST(Surface, ShadingNormalStaysOnTheSideOfTheGeometricOne) {
  auto mesh = make_rectangle({2, 2});
  mesh->normals.assign(4, glm::normalize(Vec3(0.3F, -1.0F, 0.0F)));  // points below
  const auto world = test::build({test::place(mesh)});
  const Ray ray{{0.1F, 1.0F, 0.2F}, {0.0F, -1.0F, 0.0F}};
  const auto hit = world->intersect(ray, RayKind::camera);
  ASSERT_TRUE(hit);
  const SurfacePoint p = world->surface(ray, *hit);
  EXPECT_EQ(p.ng, Vec3(0, 1, 0));
  EXPECT_GT(p.ns.y, 0.9F);
}

TEST(Surface, MissingOrSingularParametersGiveSomeTangents) {
  // Without UVs, with all UVs equal, with normals of length zero, and at the poles.
  auto plain = make_rectangle({2, 2});
  plain->uvs.clear();
  auto constant = make_rectangle({2, 2});
  constant->uvs.assign(4, Vec2(0.5F));
  constant->normals.assign(4, Vec3(0.0F));
  const std::vector<std::vector<Placement>> worlds{
      {test::place(plain)},
      {test::place(constant)},
      {test::place(Shape::Kind::sphere, 1.0F, 1.0F)},
      {test::place(Shape::Kind::disk, 1.0F, 1.0F)},
  };
  for (const auto& placements : worlds) {
    const auto world = test::build(placements, test::kInstanceAll);
    const Ray ray{{0.0F, 3.0F, 0.0F}, {0.0F, -1.0F, 0.0F}};
    const auto hit = world->intersect(ray, RayKind::camera);
    ASSERT_TRUE(hit);
    const SurfacePoint p = world->surface(ray, *hit);
    EXPECT_EQ(p.ng, Vec3(0, 1, 0));
    EXPECT_EQ(p.ns, Vec3(0, 1, 0));
    EXPECT_NEAR(glm::length(glm::cross(p.dpdu, p.dpdv)), 1.0F, 1e-5F);
    EXPECT_EQ(p.dpdu.y, 0.0F);
    EXPECT_EQ(p.dpdv.y, 0.0F);
  }
}

}  // namespace
}  // namespace hyades::core
