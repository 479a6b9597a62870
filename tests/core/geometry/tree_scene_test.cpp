// The portable class: what rays meet depends on no hierarchy.
#include "core/geometry/tree_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "core/geometry/curve_set.h"
#include "tests/core/geometry/test_worlds.h"

namespace hyades::core {
namespace {

using test::Random;

/// Triangles of all sizes, some of them twice, some seen edge-on from the axes, some without area.
std::shared_ptr<TriangleMesh> make_soup(size_t count, Random& random) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "soup";
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto first = static_cast<uint32_t>(mesh->positions.size());
    mesh->positions.insert(mesh->positions.end(), {a, b, c});
    mesh->triangles.push_back({first, first + 1, first + 2});
  };
  while (mesh->triangles.size() < count) {
    const float size = std::exp(random.uniform(-6.0F, 0.5F));
    Vec3 a = test::in_box(random, Vec3(-1.0F), Vec3(1.0F));
    Vec3 b = a + size * random.direction();
    Vec3 c = a + size * random.direction();
    if (random.uniform() < 0.3F) {
      const int flat = static_cast<int>(test::pick(random, 3));
      a[flat] = b[flat] = c[flat] = 0.25F * static_cast<float>(test::pick(random, 5));
    }
    add(a, b, c);
    if (random.uniform() < 0.3F) add(b, c, a);
    if (random.uniform() < 0.05F) add(a, a, b);
  }
  finish_mesh(*mesh);
  return mesh;
}

std::vector<Ray> make_rays(const TriangleMesh& mesh, size_t count, Random& random) {
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const auto& t = mesh.triangles[test::pick(random, mesh.triangles.size())];
    const auto corner = [&](size_t k) { return mesh.positions[t[k]]; };
    Ray ray;
    ray.origin = test::in_box(random, Vec3(-2.0F), Vec3(2.0F));
    Vec3 to = corner(0);
    if (random.uniform() < 0.7F) to += random.uniform() * (corner(1) - to);
    if (random.uniform() < 0.6F) to += random.uniform() * (corner(2) - to);
    const float axes = random.uniform();
    if (axes < 0.1F) ray.origin = to - Vec3(0.0F, 0.0F, 1.5F);
    if (axes > 0.9F) ray.origin.y = to.y;
    if (to == ray.origin) continue;
    ray.direction = glm::normalize(to - ray.origin);
    ray.time = random.uniform();
    rays.push_back(ray);
  }
  return rays;
}

/// What a ray meets of many scenes: the nearest, of those at one distance the one of least number.
struct Met {
  double t;
  uint32_t number;
  uint32_t primitive;
  bool operator==(const Met&) const = default;
};

/// A mesh in its world cut into scenes of so many triangles each, all numbered as in the whole.
class Pieces {
 public:
  Pieces(const Shape& whole, size_t each, const Motion* motion) {
    const auto& triangles = whole.mesh->triangles;
    for (size_t first = 0; first < triangles.size(); first += each) {
      auto part = std::make_shared<TriangleMesh>(*whole.mesh);
      const size_t end = std::min(first + each, triangles.size());
      part->triangles.assign(triangles.begin() + static_cast<ptrdiff_t>(first),
                             triangles.begin() + static_cast<ptrdiff_t>(end));
      Shape shape = whole;
      shape.mesh = part;
      buffers_.push_back(make_mesh_buffers(shape, motion));
      TreeBuilder builder;
      builder.add_mesh(*buffers_.back(), kAllRays, 0);
      scenes_.push_back(*builder.commit());
      firsts_.push_back(static_cast<uint32_t>(first));
    }
  }

  std::optional<Met> nearest(const Ray& ray) const {
    std::optional<Met> best;
    for (size_t i = 0; i < scenes_.size(); ++i) {
      const auto hit = scenes_[i]->nearest(ray, RayKind::diffuse, kNearest);
      if (!hit) continue;
      const Met met{hit->t, hit->number, firsts_[i] + hit->primitive};
      if (!best || std::tie(met.t, met.primitive) < std::tie(best->t, best->primitive)) best = met;
    }
    return best;
  }
  bool occluded(const Ray& ray) const {
    return std::any_of(scenes_.begin(), scenes_.end(),
                       [&](const auto& scene) { return scene->occluded(ray); });
  }

 private:
  std::vector<std::shared_ptr<const MeshBuffers>> buffers_;
  std::vector<std::shared_ptr<const RayScene>> scenes_;
  std::vector<uint32_t> firsts_;
};

/// Whether a hierarchy of all finds what is found among pieces of one and of seven triangles, to
/// the bit. How many of the rays meet something.
size_t expect_same_hits(const Shape& shape, const Motion* motion, const std::vector<Ray>& rays) {
  const FpMode mode;
  const Pieces whole(shape, shape.mesh->triangles.size(), motion);
  const Pieces ones(shape, 1, motion);
  const Pieces sevens(shape, 7, motion);
  size_t hits = 0;
  for (const Ray& ray : rays) {
    const auto met = whole.nearest(ray);
    EXPECT_EQ(met, ones.nearest(ray));
    EXPECT_EQ(met, sevens.nearest(ray));
    EXPECT_EQ(whole.occluded(ray), met.has_value());
    if (testing::Test::HasFailure()) return 0;
    if (!met) continue;
    ++hits;
    // It lies at the very end of what a shorter ray looks at.
    Ray shorter = ray;
    shorter.t_max = static_cast<float>(met->t);
    EXPECT_EQ(whole.nearest(shorter), ones.nearest(shorter));
    EXPECT_EQ(whole.occluded(shorter), ones.occluded(shorter));
  }
  return hits;
}

TEST(TreeScene, HitsDoNotDependOnTheHierarchy) {
  Random random(11);
  for (const float scale : {1.0F, 1e-3F, 1e5F}) {
    for (const float offset : {0.0F, 300.0F}) {
      SCOPED_TRACE(testing::Message() << "scale " << scale << ", offset " << offset);
      const auto soup = make_soup(400, random);
      std::vector<Ray> rays = make_rays(*soup, 2000, random);
      const auto moved = [&](const Vec3& p) { return scale * (p + Vec3(offset)); };
      for (Vec3& p : soup->positions) p = moved(p);
      for (Ray& ray : rays) ray.origin = moved(ray.origin);
      finish_mesh(*soup);
      Shape shape;
      shape.mesh = soup;
      EXPECT_GT(expect_same_hits(shape, nullptr, rays), 1500U);
    }
  }
}

TEST(TreeScene, NorDoThoseOfVerticesThatMove) {
  Random random(13);
  Shape shape;
  shape.mesh = make_soup(300, random);
  const Motion motion({Mat4(1.0F), test::translation({0.2F, 0.1F, 0.0F}),
                       test::translation({0.1F, 0.5F, -0.3F}) * test::random_rotation(random)});
  EXPECT_GT(expect_same_hits(shape, &motion, make_rays(*shape.mesh, 3000, random)), 1000U);
}

/// Worlds of copies, instances and still ones: the first placement's of what lies in one place.
TEST(TreeScene, OfTwoInOnePlaceTheFirstIsMet) {
  Random random(14);
  const auto ball = test::make_ball(2);
  std::vector<Placement> placements;
  for (int i = 0; i < 3; ++i) placements.push_back(test::place(ball));
  Placement instance = test::place(test::make_ball(2));
  instance.changes_between_frames = true;
  placements.push_back(instance);
  placements.push_back(instance);
  for (const BuildThresholds& thresholds : {BuildThresholds{}, test::kInstanceAll}) {
    for (size_t first = 0; first < placements.size(); ++first) {
      const std::vector<Placement> some(placements.begin() + static_cast<ptrdiff_t>(first),
                                        placements.end());
      GeometryCache cache;
      const auto world = build_world(some, cache, RenderClass::portable, thresholds);
      ASSERT_TRUE(world);
      for (int i = 0; i < 500; ++i) {
        const Ray ray{3.0F * random.direction(), {}};
        Ray aimed = ray;
        aimed.direction = glm::normalize(0.5F * random.direction() - ray.origin);
        const auto hit = (*world)->intersect(aimed, RayKind::camera);
        ASSERT_TRUE(hit);
        // An instance's distances are rounded in another space: it may be nearer by a hair.
        const bool decided = first >= 3 || (first < 2 && hit->object < 3);
        EXPECT_TRUE(!decided || hit->object == 0);
      }
    }
  }
}

/// Strands, quadrics, meshes that stand and instances that move, some of them unseen by the camera;
/// no shape twice.
std::vector<Placement> one_of_each(Random& random) {
  std::vector<Placement> all;
  const auto somewhere = [&] {
    return test::translation(2.0F * random.direction()) * test::random_rotation(random);
  };
  for (int i = 0; i < 24; ++i) {
    Placement made;
    const Mat4 at = somewhere();
    if (i % 4 == 0) {
      StrandList tuft;
      for (int strand = 0; strand < 20; ++strand) {
        const Vec3 root = test::in_box(random, Vec3(-0.5F), Vec3(0.5F));
        const Vec3 way = random.direction();
        for (int k = 0; k < 4; ++k) {
          tuft.points.push_back(root + 0.3F * static_cast<float>(k) * way);
          tuft.radii.push_back(0.04F);
        }
        tuft.sizes.push_back(4);
      }
      made.shape.kind = Shape::Kind::curves;
      made.shape.curves = *make_curve_set(tuft, CurveBasis::catmull_rom);
      made.to_world = {at};
    } else if (i % 4 == 1) {
      const Shape::Kind kinds[] = {Shape::Kind::sphere, Shape::Kind::disk, Shape::Kind::cylinder};
      made = test::place(kinds[i / 4 % 3], 0.6F, 1.0F, {at, test::translation({0.2F, 0, 0}) * at});
    } else {
      made = test::place(make_soup(60, random), {at});
      made.changes_between_frames = i % 4 == 2;
      if (i % 8 == 2) made.to_world.push_back(test::translation({0, 0.3F, 0}) * at);
    }
    if (i % 5 == 0) made.seen_by = RayKind::scattered | RayKind::shadow;
    all.push_back(made);
  }
  return all;
}

TEST(TreeScene, WhatIsMetDoesNotDependOnWhatElseIsThere) {
  Random random(15);
  const std::vector<Placement> placements = one_of_each(random);
  GeometryCache cache;
  const auto all = build_world(placements, cache, RenderClass::portable, test::kInstanceAll);
  ASSERT_TRUE(all) << all.error().message;
  std::vector<std::shared_ptr<const World>> alone;
  for (const Placement& placement : placements) {
    GeometryCache own;
    alone.push_back(*build_world({placement}, own, RenderClass::portable, test::kInstanceAll));
  }
  const FpMode mode;
  std::vector<int> met(placements.size());
  for (int n = 0; n < 20'000; ++n) {
    Ray ray;
    ray.origin = test::in_box(random, Vec3(-4.0F), Vec3(4.0F));
    ray.direction = glm::normalize(2.0F * random.direction() - ray.origin);
    ray.time = random.uniform();
    for (const RayKind kind : {RayKind::camera, RayKind::diffuse}) {
      const auto hit = (*all)->intersect(ray, kind);
      std::optional<Hit> nearest;
      bool hidden = false;
      for (const auto& world : alone) {
        const auto one = world->intersect(ray, kind);
        if (one && (!nearest || one->t < nearest->t)) nearest = one;
        hidden |= world->occluded(ray);
      }
      ASSERT_EQ(hit.has_value(), nearest.has_value());
      ASSERT_EQ((*all)->occluded(ray), hidden);
      if (!hit) continue;
      ++met[hit->object];
      const auto own = alone[hit->object]->intersect(ray, kind);
      ASSERT_TRUE(own);
      ASSERT_EQ(hit->t, nearest->t);
      ASSERT_EQ(std::tie(hit->primitive, hit->t, hit->u, hit->v),
                std::tie(own->primitive, own->t, own->u, own->v));
    }
  }
  EXPECT_GT(*std::min_element(met.begin(), met.end()), 20);
}

}  // namespace
}  // namespace hyades::core
