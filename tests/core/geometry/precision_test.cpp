// T18: closed meshes do not leak, rays do not meet the surface they leave, and surfaces very near
// are still found; at scales from a thousandth to a million units, near the origin and far off it.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "core/base/fp_mode.h"
#include "core/geometry/read_mesh.h"
#include "tests/core/geometry/test_worlds.h"
#include "tests/support/shared_assets.h"

namespace hyades::core {
namespace {

using test::Random;

constexpr float kScales[] = {1e-3F, 1.0F, 1e3F, 1e6F};

/// Distances from the origin in sizes of the object.
constexpr float kOffsets[] = {0.0F, 1.0F, 30.0F};

/// The last: vertices move one by one, since at time 0 the object is a point. All times are late.
enum class Way { direct, instance, moving, growing };

std::shared_ptr<const World> build_way(const std::shared_ptr<const TriangleMesh>& mesh,
                                       const Mat4& m, Way way) {
  Placement p = test::place(mesh, {m});
  p.changes_between_frames = way == Way::instance;
  if (way == Way::moving) {
    p.to_world.push_back(test::translation(0.1F * Vec3(m[1]) + 0.2F * Vec3(m[0])) * m);
  }
  if (way == Way::growing) {
    p.to_world.insert(p.to_world.begin(), Mat4(Vec4(0.0F), Vec4(0.0F), Vec4(0.0F), m[3]));
  }
  return test::build({p}, test::kInstanceAll);
}

float random_time(test::Random& random) { return random.uniform(0.5F, 1.0F); }

/// Calls body(world) for a mesh at every scale and offset and in every way.
template <class Body>
void everywhere(const std::shared_ptr<const TriangleMesh>& mesh, uint64_t seed, const Body& body) {
  Random random(seed);
  const FpMode mode;
  for (const Way way : {Way::direct, Way::instance, Way::moving, Way::growing}) {
    for (const float scale : kScales) {
      for (const float offset : kOffsets) {
        const Mat4 m = test::translation(scale * offset * random.direction()) *
                       test::random_rotation(random) *
                       test::scaling(scale * Vec3(1.0F, 0.5F, 1.5F));
        SCOPED_TRACE(mesh->name + ", way " + std::to_string(static_cast<int>(way)) + ", scale " +
                     std::to_string(scale) + ", offset " + std::to_string(offset));
        body(*build_way(mesh, m, way), random);
      }
    }
  }
}

Vec3 corner(const World& world, size_t triangle, int k, float time) {
  const TriangleMesh& mesh = *world.placement(0).shape.mesh;
  return transform_point(world.transform_at(0, time), mesh.positions[mesh.triangles[triangle][k]]);
}

enum class Target { face, edge, vertex };

/// Aims from `from` at a place inside a random triangle, at one on its edge, or at a vertex.
Ray aim(const World& world, const Vec3& from, float time, Target target, Random& random) {
  const size_t triangle = test::pick(random, world.placement(0).shape.mesh->triangles.size());
  const Vec3 a = corner(world, triangle, 0, time);
  const Vec3 b = corner(world, triangle, 1, time);
  const Vec3 c = corner(world, triangle, 2, time);
  Vec3 to = a;
  if (target != Target::vertex) to += random.uniform() * (b - a);
  if (target == Target::face) to += random.uniform() * (c - to);
  Ray ray;
  ray.origin = from;
  ray.direction = Vec3(glm::normalize(Vec3d(to) - Vec3d(from)));
  ray.time = time;
  return ray;
}

/// Counts rays from inside a closed mesh that escape: through faces and edges none may. Embree's
/// robust test gives neighbours opposite signs along their common edge, exactly, so that one of
/// them is hit; but around a vertex rounding may choose the signs such that no triangle claims it.
/// That was measured for 3 in 10,000 (ball) to 4 in 1000 (bunny) of the rays that aim exactly at a
/// vertex; a ray that does not passes one as near as that once in about 1e9. The portable class
/// lets none through.
class Leaks {
 public:
  void aim_from(const World& world, const Vec3& from, float time, Random& random) {
    for (const Target target : {Target::face, Target::edge, Target::vertex}) {
      const Ray ray = aim(world, from, time, target, random);
      const bool escaped = !world.intersect(ray, RayKind::diffuse) || !world.occluded(ray);
      if (escaped) ++(target == Target::vertex ? at_vertices_ : elsewhere_);
    }
    ++tried_;
  }
  void check() const {
    EXPECT_EQ(elsewhere_, 0U);
    const bool exact = test::tested_class() == RenderClass::portable;
    EXPECT_LE(at_vertices_, exact ? 0 : 5 + tried_ / 100);
  }

 private:
  size_t elsewhere_ = 0;
  size_t at_vertices_ = 0;
  size_t tried_ = 0;
};

void expect_closed(const std::shared_ptr<const TriangleMesh>& mesh, size_t count, uint64_t seed) {
  everywhere(mesh, seed, [&](const World& world, Random& random) {
    Leaks leaks;
    for (size_t i = 0; i < count; ++i) {
      const float time = random_time(random);
      // A place inside: between the centre of the object and one of its points.
      const Vec3 center = transform_point(world.transform_at(0, time), Vec3(0.0F));
      const Vec3 at = corner(world, test::pick(random, mesh->triangles.size()), 0, time);
      leaks.aim_from(world, center + 0.5F * random.uniform() * (at - center), time, random);
    }
    leaks.check();
  });
}

TEST(Precision, ClosedBallsDoNotLeak) { expect_closed(test::make_ball(4), 3000, 1); }
TEST(Precision, ClosedBoxesDoNotLeak) { expect_closed(make_box({1, 1, 1}), 3000, 2); }

std::shared_ptr<TriangleMesh> bunny() {
  const std::string file = test::shared_file("assets/meshes/bunny_closed_75k.obj");
  if (!std::filesystem::exists(file)) return nullptr;
  auto mesh = read_mesh(*make_file_resolver(""), file);
  EXPECT_TRUE(mesh) << mesh.error().message;
  return *mesh;
}

TEST(Precision, TheBunnyDoesNotLeak) {
  const auto mesh = bunny();
  if (mesh == nullptr) GTEST_SKIP() << "the shared assets are not here";
  const FpMode mode;
  Random random(3);
  for (const float scale : {1e-3F, 1.0F, 1e6F}) {
    const auto world =
        build_way(mesh, test::random_rotation(random) * test::scaling(Vec3(scale)), Way::direct);
    const Bounds b = world->bounds();
    Leaks leaks;
    for (int i = 0; i < 20; ++i) {
      // Half way between the first two surfaces on a line through it lies the inside.
      const Vec3 out = b.center() + glm::length(b.size()) * random.direction();
      const Ray in{out, glm::normalize(b.center() - out)};
      const auto first = world->intersect(in, RayKind::diffuse);
      ASSERT_TRUE(first);
      const auto second =
          world->intersect(spawn_ray(world->surface(in, *first), in.direction), RayKind::diffuse);
      ASSERT_TRUE(second);
      const Vec3 from = in.at(first->t + 0.5F * second->t);
      for (int k = 0; k < 700; ++k) leaks.aim_from(*world, from, 0.0F, random);
    }
    leaks.check();
  }
}

/// A point of the mesh seen from a random place, at a random time.
std::optional<SurfacePoint> random_point(const World& world, Random& random) {
  const float time = random_time(random);
  const Vec3 center = transform_point(world.transform_at(0, time), Vec3(0.0F));
  const Vec3 from = center + 2.0F * glm::length(world.bounds().size()) * random.direction();
  const Ray ray = aim(world, from, time, Target::face, random);
  const auto hit = world.intersect(ray, RayKind::diffuse);
  if (!hit) return std::nullopt;
  return world.surface(ray, *hit);
}

/// A direction off the surface; every third one grazes it.
Vec3 outward(const SurfacePoint& p, Random& random) {
  Vec3 d = random.direction();
  if (test::pick(random, 3) == 0) d = glm::cross(d, p.ng) + random.uniform(0.0F, 1e-3F) * p.ng;
  d = glm::normalize(d);
  return glm::dot(d, p.ng) < 0.0F ? -d : d;
}

/// Rays that leave a convex body meet nothing; rays into it meet its far side, but for those that
/// start within rounding of an edge (at most one in a thousand).
void expect_clean(const std::shared_ptr<const TriangleMesh>& mesh, size_t count, uint64_t seed) {
  everywhere(mesh, seed, [&](const World& world, Random& random) {
    size_t hit_itself = 0;
    size_t lost = 0;
    size_t tried = 0;
    for (size_t i = 0; i < count; ++i) {
      const auto p = random_point(world, random);
      if (!p) continue;
      ++tried;
      const Vec3 d = outward(*p, random);
      const Ray out = spawn_ray(*p, d);
      if (world.intersect(out, RayKind::diffuse) || world.occluded(out)) ++hit_itself;
      const Ray in = spawn_ray(*p, -d);
      const auto far = world.intersect(in, RayKind::diffuse);
      if (far && far->primitive == p->primitive) ++hit_itself;
      if (!far) ++lost;
    }
    EXPECT_GT(tried, count / 2);
    EXPECT_EQ(hit_itself, 0U);
    EXPECT_LE(lost, 1 + tried / 1000);
  });
}

TEST(Precision, BallsDoNotMeetThemselves) { expect_clean(test::make_ball(3), 1500, 4); }
TEST(Precision, CrystalsDoNotMeetThemselves) { expect_clean(test::make_ball(0), 1500, 5); }
TEST(Precision, BoxesDoNotMeetThemselves) { expect_clean(make_box({1, 1, 1}), 1500, 6); }

TEST(Precision, TheBunnyDoesNotMeetItself) {
  const auto mesh = bunny();
  if (mesh == nullptr) GTEST_SKIP() << "the shared assets are not here";
  everywhere(mesh, 7, [&](const World& world, Random& random) {
    for (int i = 0; i < 500; ++i) {
      const auto p = random_point(world, random);
      if (!p) continue;
      const Vec3 d = outward(*p, random);
      for (const float side : {1.0F, -1.0F}) {
        const auto hit = world.intersect(spawn_ray(*p, side * d), RayKind::diffuse);
        EXPECT_FALSE(hit && hit->primitive == p->primitive);
      }
    }
  });
}

TEST(Precision, QuadricsDoNotMeetThemselves) {
  Random random(8);
  const FpMode mode;
  for (const float scale : kScales) {
    for (const float offset : kOffsets) {
      for (const auto kind : {Shape::Kind::sphere, Shape::Kind::disk, Shape::Kind::cylinder}) {
        const Mat4 m =
            test::translation(scale * offset * random.direction()) * test::random_rotation(random);
        const auto world = test::build({test::place(kind, scale, scale, {m})});
        size_t tried = 0;
        for (int i = 0; i < 500; ++i) {
          const Vec3 center(m[3]);
          const Vec3 from = center + 4.0F * scale * random.direction();
          const Ray ray{from, glm::normalize(center + 0.7F * scale * random.direction() - from)};
          const auto hit = world->intersect(ray, RayKind::diffuse);
          if (!hit) continue;
          ++tried;
          const SurfacePoint p = world->surface(ray, *hit);
          const Vec3 d = outward(p, random);
          const Ray out = spawn_ray(p, d);
          EXPECT_FALSE(world->intersect(out, RayKind::diffuse));
          EXPECT_FALSE(world->occluded(out));
          const auto far = world->intersect(spawn_ray(p, -d), RayKind::diffuse);
          if (kind == Shape::Kind::sphere) {
            // The chord into a sphere has length 2 r cos.
            const float cosine = glm::dot(d, p.ng);
            ASSERT_TRUE(far) << "scale " << scale << " offset " << offset;
            if (cosine < 0.1F) continue;
            EXPECT_NEAR(far->t, 2.0F * scale * cosine, 1e-5F * scale * (1.0F + offset));
          }
        }
        EXPECT_GT(tried, 50U);
      }
    }
  }
}

TEST(Precision, ParallelSurfacesVeryNearAreFound) {
  // Two sheets, a ten thousandth of their size apart.
  constexpr float kGap = 1e-4F;
  auto mesh = make_rectangle({1, 1});
  auto sheet = std::make_shared<TriangleMesh>(*mesh);
  for (const Vec3& p : mesh->positions) sheet->positions.push_back(p + Vec3(0.0F, kGap, 0.0F));
  sheet->uvs.clear();
  sheet->triangles.push_back({4, 5, 6});
  sheet->triangles.push_back({4, 6, 7});
  sheet->name = "sheets";
  finish_mesh(*sheet);
  everywhere(sheet, 9, [&](const World& world, Random& random) {
    for (int i = 0; i < 300; ++i) {
      const float time = random_time(random);
      const float u = random.uniform(0.1F, 0.5F);
      const auto triangle = static_cast<uint32_t>(test::pick(random, 2));
      const SurfacePoint p = world.triangle_point(0, triangle, u, 0.4F, time);
      Vec3 d = random.direction();
      if (glm::dot(d, p.ng) < 0.0F) d = -d;
      if (glm::dot(d, p.ng) < 0.1F) d = p.ng;
      const auto hit = world.intersect(spawn_ray(p, d), RayKind::diffuse);
      ASSERT_TRUE(hit);
      EXPECT_GE(hit->primitive, 2U);
      const SurfacePoint q = world.triangle_point(0, triangle + 2, u, 0.4F, time);
      EXPECT_TRUE(world.occluded(spawn_ray_to(p, q.position + (q.position - p.position), 0.0F)));
      EXPECT_FALSE(world.occluded(spawn_ray_to(p, q)));
      EXPECT_FALSE(world.occluded(spawn_ray_to(p, q.position, q.clearance)));
    }
  });
}

TEST(Precision, ShadowRaysReachTheirTarget) {
  // Between any two points of a ball's inside nothing lies, grazing ones included.
  everywhere(test::make_ball(3), 10, [&](const World& world, Random& random) {
    size_t blocked = 0;
    size_t blocked_by_clearance = 0;
    constexpr size_t kCount = 1000;
    for (size_t i = 0; i < kCount; ++i) {
      const float time = random_time(random);
      const size_t n = world.placement(0).shape.mesh->triangles.size();
      const auto point = [&] {
        const auto triangle = static_cast<uint32_t>(test::pick(random, n));
        const float u = random.uniform(0.1F, 0.5F);
        return world.triangle_point(0, triangle, u, random.uniform(0.1F, 0.4F), time);
      };
      const SurfacePoint p = point();
      const SurfacePoint q = point();
      if (p.primitive == q.primitive) continue;
      if (world.occluded(spawn_ray_to(p, q))) ++blocked;
      if (world.occluded(spawn_ray_to(p, q.position, q.clearance))) ++blocked_by_clearance;
    }
    EXPECT_EQ(blocked, 0U);
    EXPECT_LE(blocked_by_clearance, kCount / 500);
  });
}

TEST(Precision, DegenerateTrianglesAreNeverHit) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "degenerate";
  Random random(11);
  for (uint32_t i = 0; i < 50; ++i) {
    // Three points on a line, exactly: multiples of a vector of small integers.
    const Vec3 a(test::in_box(random, Vec3(-1.0F), Vec3(1.0F)));
    const Vec3 d = glm::round(8.0F * random.direction()) / 8.0F;
    const Vec3 base = glm::round(64.0F * a) / 64.0F;
    mesh->positions.insert(mesh->positions.end(), {base, base + d, base - 2.0F * d});
    mesh->triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    mesh->triangles.push_back({3 * i, 3 * i, 3 * i + 1});
    mesh->triangles.push_back({3 * i, 3 * i, 3 * i});
  }
  finish_mesh(*mesh);
  for (const bool instance : {false, true}) {
    Placement p = test::place(mesh);
    p.changes_between_frames = instance;
    const auto world = test::build({p}, test::kInstanceAll);
    for (size_t i = 0; i < 5000; ++i) {
      const Vec3 from = 3.0F * random.direction();
      const Vec3 to = mesh->positions[test::pick(random, mesh->positions.size())];
      const Ray ray{from, glm::normalize(to - from)};
      EXPECT_FALSE(world->intersect(ray, RayKind::diffuse));
      EXPECT_FALSE(world->occluded(ray));
    }
    // Their points are still points: sampling may land there.
    const SurfacePoint q = world->triangle_point(0, 2, 0.3F, 0.3F, 0.0F);
    EXPECT_NEAR(glm::length(q.ng), 1.0F, 1e-6F);
  }
}

}  // namespace
}  // namespace hyades::core
