// Strands of hair: what World says about them, against closed forms and the definition of a tube.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/geometry/affine.h"
#include "core/geometry/curve_set.h"
#include "core/geometry/mesh_attributes.h"
#include "tests/core/geometry/test_worlds.h"

namespace hyades::core {
namespace {

using test::Random;

std::shared_ptr<CurveSet> curves_of(const StrandList& list, CurveBasis basis) {
  auto made = make_curve_set(list, basis);
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
  return *made;
}

Placement placed(std::shared_ptr<const CurveSet> curves, const Mat4& to_world = Mat4(1.0F)) {
  Placement p;
  p.shape.kind = Shape::Kind::curves;
  p.shape.curves = std::move(curves);
  p.to_world = {to_world};
  return p;
}

std::shared_ptr<const World> world_of(std::vector<Placement> placements) {
  GeometryCache cache;
  auto world = build_world(std::move(placements), cache, test::tested_class());
  EXPECT_TRUE(world.ok()) << (world.ok() ? "" : world.error().message);
  return *world;
}

/// Strands that wind at random, thick enough to be met.
StrandList winding_strands(Random& random, size_t count, uint32_t points) {
  StrandList list;
  for (size_t s = 0; s < count; ++s) {
    Vec3 at = test::in_box(random, Vec3(-1.0F), Vec3(1.0F));
    Vec3 way = 0.2F * random.direction();
    for (uint32_t i = 0; i < points; ++i) {
      list.points.push_back(at);
      list.radii.push_back(random.uniform(0.01F, 0.03F));
      way = 0.2F * glm::normalize(way + 0.1F * random.direction());
      at += way;
    }
    list.sizes.push_back(points);
  }
  return list;
}

TEST(Curves, StraightStrandIsACylinder) {
  StrandList list;
  for (const float y : {0.0F, 1.0F, 2.0F, 3.0F}) {
    list.points.emplace_back(0.0F, y, 0.0F);
    list.radii.push_back(0.25F);
  }
  list.sizes = {4};
  Placement tube;
  tube.shape.kind = Shape::Kind::cylinder;
  tube.shape.radius = 0.25F;
  tube.shape.height = 3.0F;
  const auto exact = world_of({tube});
  for (const CurveBasis basis : {CurveBasis::catmull_rom, CurveBasis::bezier}) {
    const auto world = world_of({placed(curves_of(list, basis))});
    Random random(3);
    int met = 0;
    int missed = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 from = Vec3(0.0F, 1.5F, 0.0F) + 4.0F * random.direction();
      const Vec3 to(random.uniform(-0.3F, 0.3F), random.uniform(0.1F, 2.9F),
                    random.uniform(-0.3F, 0.3F));
      const Ray ray{from, glm::normalize(to - from)};
      SurfacePoint a;
      SurfacePoint b;
      if (!exact->nearest(ray, RayKind::camera, b) || b.position.y < 0.01F ||
          b.position.y > 2.99F) {
        continue;
      }
      // Embree misses few: rays that graze the strand, or go along it.
      const float slant = std::abs(glm::dot(b.ng, ray.direction));
      const bool found = world->nearest(ray, RayKind::camera, a);
      if (!found || a.t > b.t + 0.01F) {
        ++missed;
        continue;
      }
      ++met;
      ASSERT_NEAR(a.t, b.t, 2e-5F / std::max(slant, 0.01F)) << i;
      ASSERT_LT(glm::length(a.ng - b.ng), 1e-3F / std::max(slant, 0.01F)) << i;
      // Catmull and Rom's end pieces are not even.
      if (basis == CurveBasis::bezier) {
        ASSERT_NEAR(a.uv.x, a.position.y / 3.0F, 1e-5F);
      }
      ASSERT_GT(std::abs(glm::normalize(a.dpdu).y), 0.9999F);
      ASSERT_NEAR(a.thickness, 0.5F, 1e-6F);
    }
    EXPECT_GT(met, 10000);
    EXPECT_LT(missed, met / 500);
  }
}

// The definition: at distance radius(u) from the curve, at a right angle to it; nothing nearer.
TEST(Curves, PointsLieOnTheTube) {
  Random random(7);
  for (const CurveBasis basis :
       {CurveBasis::catmull_rom, CurveBasis::bezier, CurveBasis::b_spline}) {
    const auto curves = curves_of(winding_strands(random, 40, 10), basis);
    const Mat4 m =
        test::translation({3, -1, 2}) * test::random_rotation(random) * test::scaling(Vec3(2.0F));
    const auto world = world_of({placed(curves, m)});
    const Affine back = Affine(m).inverse();
    int met = 0;
    for (int i = 0; i < 40000; ++i) {
      const Vec3 from = world->bounds().center() + 8.0F * random.direction();
      const Vec3 to = world->bounds().center() + 1.5F * random.direction();
      const Ray ray{from, glm::normalize(to - from)};
      SurfacePoint p;
      if (!world->nearest(ray, RayKind::camera, p)) continue;
      ++met;
      ASSERT_EQ(p.curves, curves.get());
      const CurvePiece piece = curves->piece(p.primitive);
      const double u = static_cast<double>(p.barycentrics.x);
      const Vec3d r = back.point(Vec3d(p.position)) - piece.at(u);
      const double radius = piece.radius_at(u);
      ASSERT_NEAR(std::sqrt(glm::dot(r, r)), radius, 1e-3 * radius + 1e-6) << i;
      ASSERT_LT(std::abs(glm::dot(r, glm::normalize(piece.derivative(u)))), 1e-3 * radius + 2e-6)
          << i;
      ASSERT_LT(glm::length(ray.at(p.t) - p.position), 1e-4F) << i;
      ASSERT_NEAR(glm::length(p.ng), 1.0F, 1e-5F);
      // Both ways of asking agree.
      const auto hit = world->intersect(ray, RayKind::camera);
      ASSERT_TRUE(hit);
      ASSERT_EQ(hit->t, p.t);
      ASSERT_EQ(world->surface(ray, *hit).position, p.position);
      // No piece that the ray crosses is nearer.
      for (uint32_t k = 0; k < curves->pieces.size() && i < 200; ++k) {
        const CurvePiece other = curves->piece(k);
        for (int n = 8; n <= 56; ++n) {
          const double at = n / 64.0;
          const Vec3d place = Affine(m).point(other.at(at));
          const Vec3d tangent = glm::normalize(Affine(m).vector(other.derivative(at)));
          if (std::abs(glm::dot(tangent, Vec3d(ray.direction))) > 0.5) continue;
          const double along = glm::dot(place - Vec3d(ray.origin), Vec3d(ray.direction));
          const Vec3d apart = place - Vec3d(ray.origin) - along * Vec3d(ray.direction);
          const double reach = 2.0 * other.radius_at(at);
          if (glm::dot(apart, apart) > 0.8 * reach * reach || along < 0.0) continue;
          ASSERT_GT(along, static_cast<double>(p.t) - 1e-4) << i << " piece " << k;
        }
      }
    }
    EXPECT_GT(met, 4000);
  }
}

// A tube that gets thinner is a cone: its normal leans towards the tip by the slope.
TEST(Curves, NormalsOfThinningStrandsLeanTowardsTheTip) {
  StrandList list;
  for (int i = 0; i < 4; ++i) {
    list.points.emplace_back(0.0F, static_cast<float>(i), 0.0F);
    list.radii.push_back(0.4F - 0.1F * static_cast<float>(i));
  }
  list.sizes = {4};
  const auto world = world_of({placed(curves_of(list, CurveBasis::bezier))});
  SurfacePoint p;
  ASSERT_TRUE(
      world->nearest({Vec3(3.0F, 1.5F, 0.0F), Vec3(-1.0F, 0.0F, 0.0F)}, RayKind::camera, p));
  EXPECT_NEAR(p.position.x, 0.25F, 1e-4F);
  EXPECT_NEAR(p.ng.y / p.ng.x, 0.1F, 1e-3F);
}

// What leaves a strand does not meet it again: outwards, nor through it to the other side. At most
// 1 in 2,000 rays that leave along it, within two degrees, may.
TEST(Curves, RaysThatLeaveDoNotMeetTheirStrandAgain) {
  Random random(11);
  StrandList list;
  for (int s = 0; s < 3; ++s) {
    for (int i = 0; i < 4; ++i) {
      list.points.emplace_back(20.0F * static_cast<float>(s), 0.8F * static_cast<float>(i), 0.0F);
      list.radii.push_back(0.0004F * std::pow(10.0F, static_cast<float>(s)));
    }
    list.sizes.push_back(4);
  }
  const Mat4 far = test::translation({100, -30, 50}) * test::random_rotation(random);
  const auto world = world_of({placed(curves_of(list, CurveBasis::bezier), far)});
  const Affine map(far);
  int again = 0;
  int rays = 0;
  for (int i = 0; i < 60000; ++i) {
    const float x = 20.0F * static_cast<float>(i % 3);
    const Vec3 to = Vec3(map.point(Vec3d(x, random.uniform(0.1F, 2.3F), 0.0)));
    const Vec3 from = to + 5.0F * random.direction();
    SurfacePoint p;
    if (!world->nearest({from, glm::normalize(to - from)}, RayKind::camera, p)) continue;
    const Vec3 out = random.direction();
    Ray ray = spawn_ray(p, out);
    ray.t_max = 5.0F;
    ++rays;
    if (world->occluded(ray)) ++again;
  }
  EXPECT_GT(rays, 30000);
  EXPECT_LT(again, rays / 2000);
}

TEST(Curves, ColorsAndUvsGoAlongTheStrand) {
  StrandList list;
  for (int i = 0; i < 5; ++i) {
    list.points.emplace_back(0.0F, static_cast<float>(i), 0.0F);
    list.radii.push_back(0.1F);
    list.colors.emplace_back(0.25F * static_cast<float>(i), 0.5F, 1.0F);
  }
  list.sizes = {5};
  const auto world = world_of({placed(curves_of(list, CurveBasis::catmull_rom))});
  SurfacePoint p;
  ASSERT_TRUE(
      world->nearest({Vec3(3.0F, 2.0F, 0.0F), Vec3(-1.0F, 0.0F, 0.0F)}, RayKind::camera, p));
  EXPECT_NEAR(p.uv.x, 0.5F, 1e-4F);
  const auto color = vertex_color(p);
  ASSERT_TRUE(color);
  EXPECT_NEAR(color->x, 0.5F, 1e-4F);
  EXPECT_NEAR(color->y, 0.5F, 1e-4F);
}

// The same as one strand that stands where the motion, or the copy, puts it.
TEST(Curves, MovingAndCopiedStrandsStandWhereTheyAre) {
  Random random(13);
  const auto curves = curves_of(winding_strands(random, 20, 8), CurveBasis::catmull_rom);
  const Mat4 a = test::translation({1, 0, 0});
  const Mat4 b = test::translation({1.5F, 0.25F, 0}) * test::scaling(Vec3(1.5F));
  Placement moving = placed(curves, a);
  moving.to_world = {a, b};
  const auto world = world_of({moving});
  const auto still = world_of({placed(curves, a * 0.5F + b * 0.5F)});
  auto instancer = std::make_shared<PointInstancer>();
  const Mat4 place = test::translation({0.25F, 0.125F, 0.0F}) * test::scaling(Vec3(1.25F));
  instancer->places = std::make_shared<std::vector<PlaceMatrix>>(
      1, PlaceMatrix(Vec3(place[0]), Vec3(place[1]), Vec3(place[2]), Vec3(place[3])));
  Placement copied = placed(curves, test::translation({0.8F, 0.0F, 0.0F}));
  copied.instancer = instancer;
  const auto copies = world_of({copied});
  int met = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = still->bounds().center() + 6.0F * random.direction();
    const Vec3 to = still->bounds().center() + 1.5F * random.direction();
    Ray ray{from, glm::normalize(to - from)};
    ray.time = 0.5F;
    SurfacePoint p;
    if (!still->nearest(ray, RayKind::camera, p)) continue;
    ++met;
    for (const auto& other : {world, copies}) {
      SurfacePoint q;
      if (!other->nearest(ray, RayKind::camera, q)) continue;
      if (std::abs(glm::dot(p.ng, ray.direction)) < 0.1F || q.primitive != p.primitive) continue;
      ASSERT_LT(glm::length(q.position - p.position), 1e-4F) << i;
      ASSERT_LT(glm::length(q.ng - p.ng), 1e-2F) << i;
      ASSERT_NEAR(q.thickness, p.thickness, 1e-4F);
    }
  }
  EXPECT_GT(met, 2000);
}

TEST(Curves, RefusesStrandsThatAreNone) {
  StrandList list;
  list.points = {Vec3(0.0F), Vec3(1.0F), Vec3(2.0F)};
  list.radii = {0.1F, 0.1F, 0.1F};
  const auto complaint = [&](CurveBasis basis) {
    const auto made = make_curve_set(list, basis);
    return made.ok() ? std::string() : made.error().message;
  };
  EXPECT_EQ(complaint(CurveBasis::catmull_rom), "it has no strands");
  list.sizes = {3};
  EXPECT_EQ(complaint(CurveBasis::catmull_rom), "");
  EXPECT_EQ(complaint(CurveBasis::bezier),
            "strand 0 has 3 points, expected 4, 7, 10, ... for basis: bezier");
  EXPECT_EQ(complaint(CurveBasis::b_spline),
            "strand 0 has 3 points, expected at least 4 for basis: b-spline");
  list.radii[1] = -0.1F;
  EXPECT_EQ(complaint(CurveBasis::catmull_rom),
            "the thickness of point 1 is -0.2, expected at least 0");
  list.radii[1] = 0.1F;
  list.points[2].y = NAN;
  EXPECT_EQ(complaint(CurveBasis::catmull_rom), "point 2 is not finite");
  list.sizes = {1, 2};
  EXPECT_EQ(complaint(CurveBasis::catmull_rom), "strand 0 has 1 points, expected at least 2");
}

}  // namespace
}  // namespace hyades::core
