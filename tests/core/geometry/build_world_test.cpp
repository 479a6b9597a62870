// How worlds are put together: what frames share, what is counted, what is refused.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "core/base/fp_mode.h"
#include "core/base/hash.h"
#include "core/geometry/embree.h"
#include "core/geometry/isa.h"
#include "tests/core/geometry/test_worlds.h"

namespace hyades::core {
namespace {

using test::Random;

uint64_t bits_of(const Vec3& v) {
  uint32_t words[3];
  std::memcpy(words, &v, sizeof(words));
  return hash_combine(hash_combine(words[0], words[1]), words[2]);
}

uint64_t bits_of(float x) {
  uint32_t word = 0;
  std::memcpy(&word, &x, sizeof(word));
  return word;
}

/// A hash of everything that `count` random rays find.
uint64_t digest(const World& world, size_t count, uint64_t seed) {
  const FpMode mode;
  Random random(seed);
  const Bounds b = world.bounds();
  uint64_t sum = 0;
  for (size_t i = 0; i < count; ++i) {
    Ray ray;
    ray.origin = test::in_box(random, b.lower, b.upper);
    ray.direction = random.direction();
    ray.time = random.uniform();
    const auto hit = world.intersect(ray, RayKind::camera);
    sum = hash_combine(sum, world.occluded(ray) ? 1 : 2);
    if (!hit) continue;
    const SurfacePoint p = world.surface(ray, *hit);
    for (const uint64_t word :
         {uint64_t{hit->object}, uint64_t{hit->primitive}, bits_of(hit->t), bits_of(hit->u),
          bits_of(hit->v), bits_of(p.position), bits_of(p.ng), bits_of(p.dpdu),
          bits_of(p.clearance), bits_of(Vec3(p.world_to_object[1]))}) {
      sum = hash_combine(sum, word);
    }
  }
  return sum;
}

/// Which placement of mixed_scene is a box that frames share.
constexpr size_t kStillBox = 7;

/// Direct meshes, coincident ones, instances, moving ones and quadrics.
std::vector<Placement> mixed_scene(int frame) {
  Random random(5);
  static const auto fine = test::make_ball(7);  // 131072 triangles
  static const auto coarse = test::make_ball(2);
  static const auto changing = test::make_ball(6);  // 32768 triangles: instanced
  std::vector<Placement> out;
  for (int i = 0; i < 6; ++i) {
    const Mat4 m = test::translation(3.0F * random.direction()) * test::random_rotation(random);
    out.push_back(test::place(i % 2 == 0 ? fine : coarse, {m}));
  }
  out.push_back(out[1]);  // the same twice: coplanar everywhere
  out.push_back(test::place(make_box({9, 9, 9})));
  static const auto lone = test::make_ball(6);  // enough to be shared
  out.push_back(test::place(lone, {test::translation({-2, 0, 0})}));
  for (const auto kind : {Shape::Kind::sphere, Shape::Kind::disk, Shape::Kind::cylinder}) {
    const Mat4 m = test::translation(3.0F * random.direction()) * test::random_rotation(random);
    out.push_back(test::place(kind, 0.7F, 1.0F, {m, test::translation(random.direction()) * m}));
  }
  const Mat4 m = test::translation({0.0F, 0.1F * static_cast<float>(frame), 0.0F});
  for (const auto& mesh : {coarse, changing}) {
    out.push_back(test::place(mesh, {m}));
    out.back().changes_between_frames = true;
  }
  out.push_back(test::place(Shape::Kind::sphere, 0.3F, 1.0F, {m}));
  out.back().changes_between_frames = true;
  return out;
}

bool counts_memory() { return test::tested_class() == RenderClass::native; }

TEST(BuildWorld, FramesShareWhatStandsStill) {
  GeometryCache cache;
  const auto first = build_world(mixed_scene(0), cache, test::tested_class());
  ASSERT_TRUE(first) << first.error().message;
  const size_t one = embree_memory();
  EXPECT_EQ(one > 1000000U, counts_memory());
  const auto second = build_world(mixed_scene(1), cache, test::tested_class());
  ASSERT_TRUE(second);
  // Only the top scene is new (Embree takes a megabyte or two for the smallest of them).
  EXPECT_LE(embree_memory() - one, one / 4);
  // What comes out of the cache has the bits of what is built afresh.
  const auto fresh = test::build(mixed_scene(1));
  EXPECT_EQ(digest(**second, 5000, 1), digest(*fresh, 5000, 1));
  EXPECT_NE(digest(**first, 5000, 1), digest(**second, 5000, 1));
}

TEST(BuildWorld, SharedGeometryOutlivesItsWorldUntilTheNextIsBuilt) {
  if (!counts_memory()) GTEST_SKIP() << "only Embree counts what it holds";
  const size_t before = embree_memory();
  GeometryCache cache;
  (void)build_world(mixed_scene(0), cache, test::tested_class());
  const size_t kept = embree_memory();
  EXPECT_GT(kept, before + 1000000U);
  (void)build_world(mixed_scene(1), cache, test::tested_class());
  EXPECT_LT(embree_memory(), kept + kept / 4);
  (void)build_world({}, cache, test::tested_class());
  EXPECT_LE(embree_memory(), before + 4096);
}

TEST(BuildWorld, ChangedStillGeometryIsBuiltAgain) {
  GeometryCache cache;
  auto placements = mixed_scene(0);
  const auto first = build_world(placements, cache, test::tested_class());
  ASSERT_TRUE(first);
  Placement& box = placements[kStillBox];
  box.to_world[0] = test::translation({1, 0, 0}) * box.to_world[0];
  const auto second = build_world(placements, cache, test::tested_class());
  ASSERT_TRUE(second);
  EXPECT_EQ(digest(**second, 2000, 2), digest(*test::build(placements), 2000, 2));
  box.seen_by = RayKind::scattered | RayKind::shadow;
  const auto third = build_world(placements, cache, test::tested_class());
  ASSERT_TRUE(third);
  EXPECT_EQ(digest(**third, 2000, 2), digest(*test::build(placements), 2000, 2));
}

TEST(BuildWorld, SharedAndDirectGeometryAgree) {
  // The still scene behind an identity instance against the same in one scene.
  auto shared = mixed_scene(0);
  shared.erase(shared.begin() + 6);  // where surfaces coincide, either may be met
  auto direct = shared;
  for (Placement& p : direct) p.changes_between_frames = false;
  const auto a = test::build(shared);
  const auto b = test::build(direct);
  Random random(3);
  for (int i = 0; i < 5000; ++i) {
    Ray ray;
    ray.origin = test::in_box(random, a->bounds().lower, a->bounds().upper);
    ray.direction = random.direction();
    ray.time = random.uniform();
    const auto hit_a = a->intersect(ray, RayKind::camera);
    const auto hit_b = b->intersect(ray, RayKind::camera);
    ASSERT_EQ(hit_a.has_value(), hit_b.has_value());
    if (!hit_a) continue;
    EXPECT_EQ(hit_a->object, hit_b->object);
    EXPECT_NEAR(hit_a->t, hit_b->t, 1e-5F);
  }
}

TEST(BuildWorld, MemoryIsCountedPerWorld) {
  const auto empty = test::build({});
  EXPECT_LT(empty->memory(), 4096U);
  const auto mesh = test::make_ball(6);  // 32768 triangles
  const auto one = test::build({test::place(mesh)});
  EXPECT_GT(one->memory(), 32768U * 40);
  EXPECT_LT(one->memory(), 32768U * 160);
  // A moved copy adds its vertices.
  const auto moved = test::build({test::place(mesh, {test::translation({1, 0, 0})})});
  const size_t vertices = mesh->positions.size() * sizeof(Vec3);
  EXPECT_NEAR(static_cast<double>(moved->memory()), static_cast<double>(one->memory() + vertices),
              static_cast<double>(one->memory()) / 10);
  // Many instances of one mesh cost little more than one.
  std::vector<Placement> many;
  for (int i = 0; i < 100; ++i) {
    many.push_back(test::place(mesh, {test::translation({3.0F * static_cast<float>(i), 0, 0})}));
  }
  EXPECT_LT(test::build(many)->memory(), one->memory() * 3 / 2);
}

TEST(BuildWorld, WorldsAreBuiltFromSeveralThreads) {
  GeometryCache cache;
  const uint64_t expected = digest(*test::build(mixed_scene(2)), 1000, 4);
  std::vector<std::thread> threads;
  std::array<uint64_t, 4> found{};
  for (size_t i = 0; i < found.size(); ++i) {
    threads.emplace_back([&, i] {
      const auto world = build_world(mixed_scene(2), cache, test::tested_class());
      if (world) found[i] = digest(**world, 1000, 4);
    });
  }
  for (std::thread& t : threads) t.join();
  for (const uint64_t f : found) EXPECT_EQ(f, expected);
}

TEST(BuildWorld, BadPlacementsAreRefused) {
  const auto ball = test::make_ball(1);
  const float nan = std::nanf("");
  const Mat4 one(1.0F);
  std::vector<std::pair<Placement, std::string>> cases{
      {test::place(nullptr), "no mesh"},
      {test::place(ball, {}), "no transform"},
      {test::place(ball, {test::scaling({1, nan, 1})}), "not finite"},
      {test::place(ball, {test::translation({kInfinity, 0, 0})}), "not finite"},
      {test::place(ball, {test::translation({1e13F, 0, 0})}), "beyond"},
      {test::place(ball, std::vector<Mat4>(200, one)), "motion steps"},
      {test::place(Shape::Kind::sphere, 0.0F, 1.0F), "radius"},
      {test::place(Shape::Kind::sphere, -1.0F, 1.0F), "radius"},
      {test::place(Shape::Kind::disk, nan, 1.0F), "radius"},
      {test::place(Shape::Kind::cylinder, 1.0F, 0.0F), "height"},
  };
  for (const auto& [placement, expected] : cases) {
    GeometryCache cache;
    const auto world = build_world({test::place(ball), placement}, cache, test::tested_class());
    ASSERT_FALSE(world) << expected;
    EXPECT_NE(world.error().message.find(expected), std::string::npos) << world.error().message;
    EXPECT_NE(world.error().message.find("object 1"), std::string::npos) << world.error().message;
  }
}

TEST(BuildWorld, SingularTransformsFlatten) {
  const auto ball = test::make_ball(3);
  const Ray down{{0.1F, 5.0F, 0.2F}, {0.0F, -1.0F, 0.0F}};
  // Made flat, a mesh is a disc; made a line or a point it is nothing, and so is a flat quadric.
  const auto flat = test::build({test::place(ball, {test::scaling({1, 0, 1})})});
  const auto hit = flat->intersect(down, RayKind::camera);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, 5.0F);
  const SurfacePoint p = flat->surface(down, *hit);
  EXPECT_EQ(std::abs(p.ng.y), 1.0F);
  EXPECT_EQ(p.ns, p.ng);
  EXPECT_TRUE(std::isfinite(p.clearance));
  for (const Mat4& m : {test::scaling({1, 0, 0}), test::scaling({0, 0, 0})}) {
    EXPECT_FALSE(test::build({test::place(ball, {m})})->intersect(down, RayKind::camera));
  }
  for (const auto kind : {Shape::Kind::sphere, Shape::Kind::disk, Shape::Kind::cylinder}) {
    const auto world = test::build({test::place(kind, 1.0F, 1.0F, {test::scaling({1, 0, 1})})});
    (void)world->intersect(down, RayKind::camera);
    EXPECT_FALSE(test::build({test::place(kind, 1.0F, 1.0F, {test::scaling({0, 0, 0})})})
                     ->intersect(down, RayKind::camera));
  }
}

TEST(BuildWorld, ExtremeScalesAndTurnsAreTraced) {
  // Embree aborts on rays that an instance's inverse matrix blows up: such meshes move vertex by
  // vertex instead. Half a turn collapses half way, a scale grows from nothing or passes through
  // it.
  const auto ball = test::make_ball(3);
  const Mat4 one(1.0F);
  const FpMode mode;
  for (const std::vector<Mat4>& steps :
       std::vector<std::vector<Mat4>>{{one, test::scaling({-1, 1, -1})},
                                      {test::scaling(Vec3(0.0F)), one},
                                      {one, test::scaling(Vec3(-1.0F))},
                                      {test::scaling(Vec3(1e-12F)), test::scaling(Vec3(1e-12F))},
                                      {test::scaling(Vec3(1e-20F)), one, one},
                                      {test::scaling({1.0F, 1e-7F, 1.0F}), one}}) {
    for (const auto kind : {Shape::Kind::mesh, Shape::Kind::sphere}) {
      Placement p = test::place(kind, 1.0F, 1.0F, steps);
      if (kind == Shape::Kind::mesh) p.shape.mesh = ball;
      const auto world = test::build({p}, test::kInstanceAll);
      Random random(1);
      for (int i = 0; i < 3000; ++i) {
        Ray ray{3.0F * random.direction(), random.direction()};
        if (i % 2 == 0) ray.origin *= 1e12F;
        if (i % 4 < 2) ray.direction = -glm::normalize(ray.origin);
        ray.time = i % 3 == 0 ? 0.5F : i % 3 == 1 ? 0.0F : random.uniform();
        (void)world->occluded(ray);
        const auto hit = world->intersect(ray, RayKind::camera);
        if (!hit) continue;
        const SurfacePoint q = world->surface(ray, *hit);
        for (const Vec3& v : {q.position, q.ng, q.ns, q.dpdu, q.dpdv}) {
          ASSERT_TRUE(std::isfinite(v.x + v.y + v.z));
        }
        ASSERT_TRUE(std::isfinite(q.clearance));
      }
      EXPECT_EQ(world->invalid_rays(), 0U);
    }
  }
}

TEST(BuildWorld, RunningOutOfMemoryIsAnError) {
  if (!counts_memory()) GTEST_SKIP() << "only Embree can be given a limit";
  const auto mesh = test::make_ball(6);
  Placement instance = test::place(mesh);
  instance.changes_between_frames = true;
  for (const Placement& p : {test::place(mesh), instance}) {
    GeometryCache cache;
    limit_embree_memory(embree_memory() + 100000);
    const auto world = build_world({p}, cache, test::tested_class());
    limit_embree_memory(0);
    ASSERT_FALSE(world);
    EXPECT_NE(world.error().message.find("out of memory"), std::string::npos);
    EXPECT_TRUE(build_world({p}, cache, test::tested_class()));
  }
}

TEST(BuildWorld, IsaIsPinned) {
  const auto isa = embree_isa();
  ASSERT_TRUE(isa) << isa.error().message;
  EXPECT_EQ(*isa, __builtin_cpu_supports("avx2") ? "avx2" : "sse4.2");
  EXPECT_FALSE(embree_version().empty());
}

/// What SameBitsOnOneThread prints in a process that begins with the words `before`.
std::string run_digest(const std::string& before) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command = "HYADES_PRINT_DIGEST=1 " + before + " '" + self +
                              "' --gtest_filter=BuildWorld.SameBitsOnOneThread";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string out;
  char buffer[256];
  while (std::fgets(buffer, sizeof(buffer), pipe) != nullptr) {
    if (std::strncmp(buffer, "digest ", 7) == 0) out = buffer;
  }
  ::pclose(pipe);
  return out;
}

// Runs itself again on one processor and on all, and compares what it prints there.
TEST(BuildWorld, SameBitsOnOneThread) {
  if (std::getenv("HYADES_PRINT_DIGEST") != nullptr) {
    std::printf("digest %016llx\n",
                static_cast<unsigned long long>(digest(*test::build(mixed_scene(0)), 20000, 9)));
    return;
  }
  const std::string all = run_digest("");
  ASSERT_FALSE(all.empty());
  if (std::system("taskset -c 0 true 2>/dev/null") != 0) GTEST_SKIP() << "no taskset here";
  EXPECT_EQ(run_digest("taskset -c 0"), all);
  EXPECT_EQ(run_digest("taskset -c 0"), all);
}

}  // namespace
}  // namespace hyades::core
