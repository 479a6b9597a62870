// Hits against brute force over all primitives in double precision, with formulas of its own: plane
// and edge sides for triangles, the textbook quadratic in long double for quadrics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "tests/core/geometry/test_worlds.h"

namespace hyades::core {
namespace {

using test::Random;
using D3 = glm::dvec3;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The matrix of a placement at a time, by the definition in world.h.
glm::dmat4 matrix_at(const Placement& p, float time) {
  const size_t n = p.to_world.size();
  if (n == 1) return glm::dmat4(p.to_world[0]);
  const double place = static_cast<double>(time) * static_cast<double>(n - 1);
  const size_t i = std::min(static_cast<size_t>(place), n - 2);
  const double f = place - static_cast<double>(i);
  return glm::dmat4(p.to_world[i]) * (1.0 - f) + glm::dmat4(p.to_world[i + 1]) * f;
}

/// A crossing, and how far inside the primitive it lies as a fraction of the primitive's size
/// (negative: outside); near 0, rounding decides.
struct Crossing {
  double t = kNever;
  double inside = -1.0;
};

Crossing cross_triangle(const D3& o, const D3& d, const D3& a, const D3& b, const D3& c) {
  const D3 n = glm::cross(b - a, c - a);
  const double denominator = glm::dot(n, d);
  if (denominator == 0.0) return {};
  const double t = glm::dot(n, a - o) / denominator;
  const D3 p = o + d * t;
  const double area2 = glm::dot(n, n);
  const auto side = [&](const D3& u, const D3& v) {
    return glm::dot(n, glm::cross(v - u, p - u)) / area2;
  };
  return {t, std::min({side(a, b), side(b, c), side(c, a)})};
}

std::vector<Crossing> cross_quadric(const D3& o, const D3& d, const Shape& s) {
  std::vector<Crossing> out;
  const auto add = [&](long double t, long double inside) {
    out.push_back({static_cast<double>(t), static_cast<double>(inside)});
  };
  const long double r = static_cast<long double>(s.radius);
  if (s.kind == Shape::Kind::disk) {
    const long double t = -static_cast<long double>(o.y) / d.y;
    const long double x = o.x + t * d.x;
    const long double z = o.z + t * d.z;
    add(t, 1.0L - std::sqrt(x * x + z * z) / r);
    return out;
  }
  const bool tube = s.kind == Shape::Kind::cylinder;
  const long double oy = tube ? 0.0L : o.y;
  const long double dy = tube ? 0.0L : d.y;
  const long double a = d.x * 1.0L * d.x + dy * dy + d.z * 1.0L * d.z;
  const long double b = 2.0L * (o.x * 1.0L * d.x + oy * dy + o.z * 1.0L * d.z);
  const long double c = o.x * 1.0L * o.x + oy * oy + o.z * 1.0L * o.z - r * r;
  const long double root2 = b * b - 4.0L * a * c;
  if (root2 < 0.0L) return out;
  for (const long double sign : {-1.0L, 1.0L}) {
    const long double t = (-b + sign * std::sqrt(root2)) / (2.0L * a);
    const long double y = (o.y + t * d.y) / static_cast<long double>(s.height);
    const long double grazing = root2 / (4.0L * a * r * r);
    add(t, tube ? std::min({grazing, y, 1.0L - y}) : grazing);
  }
  return out;
}

struct Nearest {
  double t = kNever;
  uint32_t object = 0;
  uint32_t primitive = 0;
  bool doubtful = false;  ///< a crossing so near an edge or another one that rounding decides
};

Nearest brute_force(const std::vector<Placement>& placements, const Ray& ray) {
  struct Found {
    double t;
    uint32_t object;
    uint32_t primitive;
    double inside;
  };
  std::vector<Found> all;
  for (uint32_t i = 0; i < placements.size(); ++i) {
    const Placement& p = placements[i];
    const glm::dmat4 m = matrix_at(p, ray.time);
    const glm::dmat4 inverse = glm::inverse(m);
    if (p.shape.kind != Shape::Kind::mesh) {
      const D3 o(inverse * glm::dvec4(D3(ray.origin), 1.0));
      const D3 d(inverse * glm::dvec4(D3(ray.direction), 0.0));
      for (const Crossing& c : cross_quadric(o, d, p.shape)) all.push_back({c.t, i, 0, c.inside});
      continue;
    }
    const TriangleMesh& mesh = *p.shape.mesh;
    for (uint32_t k = 0; k < mesh.triangles.size(); ++k) {
      const auto corner = [&](int j) {
        return D3(m * glm::dvec4(D3(mesh.positions[mesh.triangles[k][j]]), 1.0));
      };
      const Crossing c =
          cross_triangle(D3(ray.origin), D3(ray.direction), corner(0), corner(1), corner(2));
      all.push_back({c.t, i, k, c.inside});
    }
  }
  constexpr double kDoubt = 1e-5;
  Nearest best;
  for (const Found& f : all) {
    if (f.inside < 0.0 || !(f.t > 0.0) || f.t >= best.t) continue;
    best = {f.t, f.object, f.primitive, false};
  }
  for (const Found& f : all) {
    const bool near_edge = std::abs(f.inside) < kDoubt && f.t > -kDoubt && f.t < best.t + kDoubt;
    const bool near_tie = f.inside > -kDoubt && std::abs(f.t - best.t) < kDoubt &&
                          (f.object != best.object || f.primitive != best.primitive);
    const bool near_start = f.inside > -kDoubt && std::abs(f.t) < kDoubt;
    best.doubtful = best.doubtful || near_edge || near_tie || near_start;
  }
  return best;
}

std::shared_ptr<TriangleMesh> random_soup(Random& random, size_t triangles) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "soup";
  for (size_t i = 0; i < triangles; ++i) {
    const Vec3 at = test::in_box(random, Vec3(-1.0F), Vec3(1.0F));
    for (int k = 0; k < 3; ++k) {
      mesh->positions.push_back(at + 0.5F * test::in_box(random, Vec3(-1.0F), Vec3(1.0F)));
    }
    const auto first = static_cast<uint32_t>(3 * i);
    mesh->triangles.push_back({first, first + 1, first + 2});
  }
  finish_mesh(*mesh);
  return mesh;
}

Mat4 random_transform(Random& random) {
  Mat4 m = test::translation(test::in_box(random, Vec3(-1.0F), Vec3(1.0F))) *
           test::random_rotation(random) *
           test::scaling(test::in_box(random, Vec3(0.3F), Vec3(2.0F)));
  if (random.uniform() < 0.5F) m[0] = -m[0];
  return m;
}

/// Compares `count` rays; at most one in a hundred may be left out as doubtful.
void compare(const std::vector<Placement>& placements, size_t count, uint64_t seed,
             const BuildThresholds& thresholds = {}) {
  const auto world = test::build(placements, thresholds);
  ASSERT_NE(world, nullptr);
  Random random(seed);
  size_t doubtful = 0;
  size_t hits = 0;
  for (size_t i = 0; i < count; ++i) {
    Ray ray;
    ray.origin = test::in_box(random, Vec3(-2.5F), Vec3(2.5F));
    ray.direction = random.direction();
    ray.time = random.uniform();
    const Nearest expected = brute_force(placements, ray);
    if (expected.doubtful) {
      ++doubtful;
      continue;
    }
    const auto hit = world->intersect(ray, RayKind::camera);
    ASSERT_EQ(hit.has_value(), expected.t < kNever) << "ray " << i;
    EXPECT_EQ(world->occluded(ray), hit.has_value());
    if (!hit) continue;
    ++hits;
    ASSERT_EQ(hit->object, expected.object) << "ray " << i;
    ASSERT_EQ(hit->primitive, expected.primitive) << "ray " << i;
    // t is exact but for its own rounding, wherever vertices were not rounded into the world.
    EXPECT_NEAR(static_cast<double>(hit->t), expected.t, 4e-6 * (1.0 + expected.t)) << "ray " << i;
    const SurfacePoint p = world->surface(ray, *hit);
    const D3 on_ray = D3(ray.origin) + D3(ray.direction) * expected.t;
    EXPECT_LT(glm::length(D3(p.position) - on_ray), 8e-6 * (1.0 + expected.t)) << "ray " << i;
    Ray until = ray;
    until.t_max = hit->t * 0.999F;
    EXPECT_FALSE(world->occluded(until)) << "ray " << i;
    until.t_max = hit->t * 1.001F;
    EXPECT_TRUE(world->occluded(until)) << "ray " << i;
  }
  EXPECT_LE(doubtful, count / 50);
  EXPECT_GE(hits, count / 20);
}

TEST(BruteForce, Triangles) {
  Random random(1);
  compare({test::place(random_soup(random, 200))}, 3000, 11);
}

TEST(BruteForce, TransformedTriangles) {
  Random random(2);
  std::vector<Placement> placements;
  for (int i = 0; i < 8; ++i) {
    placements.push_back(test::place(random_soup(random, 25), {random_transform(random)}));
  }
  compare(placements, 3000, 12);
}

TEST(BruteForce, Instances) {
  Random random(3);
  const auto soup = random_soup(random, 30);
  std::vector<Placement> placements;
  for (int i = 0; i < 6; ++i) {
    placements.push_back(test::place(soup, {random_transform(random)}));
    placements.back().changes_between_frames = true;
  }
  compare(placements, 3000, 13, test::kInstanceAll);
}

TEST(BruteForce, MovingInstances) {
  Random random(4);
  std::vector<Placement> placements;
  for (int i = 0; i < 6; ++i) {
    // Two, three and four steps; neighbours differ little enough never to be singular between.
    std::vector<Mat4> steps{random_transform(random)};
    for (int k = 0; k <= i % 3; ++k) {
      steps.push_back(test::translation(0.5F * random.direction()) * steps.back());
      steps.back()[1] *= 1.2F;
    }
    placements.push_back(test::place(random_soup(random, 30), steps));
  }
  compare(placements, 3000, 14);
}

TEST(BruteForce, MovingVertices) {
  // Motions that no instance can follow: half a turn, through a point, mirrored on the way.
  Random random(7);
  std::vector<Placement> placements;
  for (int i = 0; i < 6; ++i) {
    const Mat4 first = random_transform(random);
    Mat4 last = first;
    if (i % 3 != 1) last[0] = -last[0];
    if (i % 3 != 2) last[1] = -last[1];
    std::vector<Mat4> steps{first, last};
    if (i >= 3) steps.push_back(test::translation(random.direction()) * first);
    placements.push_back(test::place(random_soup(random, 30), steps));
  }
  compare(placements, 3000, 19);
}

TEST(BruteForce, Quadrics) {
  Random random(5);
  std::vector<Placement> placements;
  for (int i = 0; i < 30; ++i) {
    const auto kind = std::vector<Shape::Kind>{Shape::Kind::sphere, Shape::Kind::disk,
                                               Shape::Kind::cylinder}[static_cast<size_t>(i) % 3];
    std::vector<Mat4> steps{random_transform(random)};
    if (i % 2 == 1) steps.push_back(test::translation(random.direction()) * steps.back());
    placements.push_back(test::place(kind, random.uniform(0.1F, 0.5F), random.uniform(0.2F, 1.0F),
                                     std::move(steps)));
  }
  compare(placements, 3000, 15);
}

TEST(BruteForce, EverythingTogether) {
  Random random(6);
  const auto soup = random_soup(random, 20);
  std::vector<Placement> placements;
  for (int i = 0; i < 12; ++i) {
    std::vector<Mat4> steps{random_transform(random)};
    if (i % 4 == 1) steps.push_back(test::translation(random.direction()) * steps.back());
    if (i % 3 == 0) {
      placements.push_back(test::place(Shape::Kind::sphere, 0.3F, 1.0F, std::move(steps)));
    } else {
      placements.push_back(test::place(i % 3 == 1 ? soup : random_soup(random, 20), steps));
    }
  }
  compare(placements, 3000, 16);
  compare(placements, 3000, 17, test::kInstanceAll);
  for (size_t i = 0; i < 6; ++i) placements[i].changes_between_frames = true;
  compare(placements, 3000, 18, test::kInstanceAll);
}

}  // namespace
}  // namespace hyades::core
