// Rays per second through World against Embree itself, one thread, and the time that meshes take to
// load and build. Google Benchmark's items_per_second are rays (or triangles) per second.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/base/fp_mode.h"
#include "core/geometry/embree.h"
#include "core/geometry/read_mesh.h"
#include "core/geometry/world.h"
#include "tests/support/shared_assets.h"

namespace {

using namespace hyades::core;

constexpr size_t kRays = size_t{1} << 16;

class Random {
 public:
  float next() { return std::uniform_real_distribution<float>(0.0F, 1.0F)(engine_); }
  Vec3 direction() {
    while (true) {
      const Vec3 v(2.0F * next() - 1.0F, 2.0F * next() - 1.0F, 2.0F * next() - 1.0F);
      const float length2 = glm::dot(v, v);
      if (length2 > 0.01F && length2 <= 1.0F) return v / std::sqrt(length2);
    }
  }

 private:
  std::mt19937 engine_{7};
};

Placement place(std::shared_ptr<const TriangleMesh> mesh, const Mat4& m = Mat4(1.0F)) {
  Placement p;
  p.shape.mesh = std::move(mesh);
  p.to_world = {m};
  return p;
}

Mat4 moved(const Vec3& by) {
  Mat4 m(1.0F);
  m[3] = Vec4(by, 1.0F);
  return m;
}

/// The dragon, the same as a bare Embree scene, and rays of several kinds.
struct Setup {
  std::shared_ptr<const TriangleMesh> mesh;
  GeometryCache cache;
  std::shared_ptr<const World> world;
  std::shared_ptr<const MeshBuffers> buffers;
  std::shared_ptr<const RayScene> bare;  ///< Embree's
  std::shared_ptr<const RayScene> tree;  ///< our own
  RTCScene bare_handle() const { return static_cast<const EmbreeScene&>(*bare).handle(); }
  std::vector<Ray> primary;  ///< from one eye, in scan order
  std::vector<Ray> bounces;  ///< diffuse, off random places of the surface
  std::vector<Ray> inner;    ///< those bounces that meet the dragon again
};

void make_rays(Setup& s) {
  Random random;
  const Bounds b = s.world->bounds();
  const float size = glm::length(b.size());
  const auto side = static_cast<size_t>(std::sqrt(static_cast<double>(kRays)));
  const Vec3 eye = b.center() + size * Vec3(0.1F, 0.2F, 0.8F);
  for (size_t i = 0; i < kRays; ++i) {
    const Vec3 at = b.center() + size * Vec3(static_cast<float>(i % side) / side - 0.5F,
                                             static_cast<float>(i / side) / side - 0.5F, 0.0F);
    s.primary.push_back({eye, glm::normalize(at - eye)});
  }
  while (s.inner.size() < kRays / 4 || s.bounces.size() < kRays) {
    const Vec3 from = b.center() + size * random.direction();
    const Vec3 to = b.center() + 0.5F * b.size() * random.direction() * random.next();
    const Ray ray{from, glm::normalize(to - from)};
    const auto hit = s.world->intersect(ray, RayKind::diffuse);
    if (!hit) continue;
    const SurfacePoint p = s.world->surface(ray, *hit);
    const Vec3 n = glm::dot(p.ng, ray.direction) < 0.0F ? p.ng : -p.ng;
    const Ray bounce = spawn_ray(p, glm::normalize(n + 0.999F * random.direction()));
    if (s.bounces.size() < kRays) s.bounces.push_back(bounce);
    if (s.world->occluded(bounce)) s.inner.push_back(bounce);
  }
}

Setup* setup() {
  static Setup* made = [] {
    const FpMode mode;
    auto s = std::make_unique<Setup>();
    const std::string file = hyades::test::shared_file("assets/meshes/dragon_100k.ply");
    auto mesh = read_mesh(*make_file_resolver(""), file);
    if (!mesh) return static_cast<Setup*>(nullptr);
    s->mesh = *mesh;
    s->world = *build_world({place(s->mesh)}, s->cache);
    s->buffers = make_mesh_buffers(place(s->mesh).shape, nullptr);
    const auto bare_scene = [&](RenderClass which) {
      const auto builder = make_scene_builder(which);
      builder->add_mesh(*s->buffers, kAllRays, 0);
      return *builder->commit();
    };
    s->bare = bare_scene(RenderClass::native);
    s->tree = bare_scene(RenderClass::portable);
    make_rays(*s);
    return s.release();
  }();
  return made;
}

RTCRayHit to_embree(const Ray& ray) {
  RTCRayHit q;
  q.ray = {ray.origin.x,
           ray.origin.y,
           ray.origin.z,
           0.0F,
           ray.direction.x,
           ray.direction.y,
           ray.direction.z,
           ray.time,
           ray.t_max,
           0xFFFFFFFFU,
           0,
           0};
  q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  q.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return q;
}

template <class Body>
void each_ray(benchmark::State& state, std::vector<Ray> Setup::*rays, const Body& body) {
  Setup* s = setup();
  if (s == nullptr) {
    state.SkipWithError("the shared assets are not here");
    return;
  }
  const FpMode mode;
  for (auto _ : state) {
    for (const Ray& ray : s->*rays) body(*s, ray);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>((s->*rays).size()));
}

void bare_nearest(benchmark::State& state, std::vector<Ray> Setup::*rays) {
  each_ray(state, rays, [](Setup& s, const Ray& ray) {
    RTCRayHit q = to_embree(ray);
    trace_nearest(s.bare_handle(), q);
    benchmark::DoNotOptimize(q);
  });
}

/// Embree, then a look at the corners of what was hit: what shading must fetch anyway, and most of
/// what World::intersect costs beyond Embree (its arithmetic is an eighth of that).
void bare_touch(benchmark::State& state, std::vector<Ray> Setup::*rays) {
  each_ray(state, rays, [](Setup& s, const Ray& ray) {
    RTCRayHit q = to_embree(ray);
    trace_nearest(s.bare_handle(), q);
    if (q.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
    Vec3 sum(0.0F);
    for (const uint32_t i : s.mesh->triangles[q.hit.primID]) sum += s.mesh->positions[i];
    benchmark::DoNotOptimize(sum);
  });
}

void bare_any(benchmark::State& state, std::vector<Ray> Setup::*rays) {
  each_ray(state, rays, [](Setup& s, const Ray& ray) {
    RTCRayHit q = to_embree(ray);
    trace_any(s.bare_handle(), q.ray);
    benchmark::DoNotOptimize(q);
  });
}

void world_nearest(benchmark::State& state, std::vector<Ray> Setup::*rays) {
  each_ray(state, rays, [](Setup& s, const Ray& ray) {
    benchmark::DoNotOptimize(s.world->intersect(ray, RayKind::diffuse));
  });
}

void world_surface(benchmark::State& state, std::vector<Ray> Setup::*rays) {
  each_ray(state, rays, [](Setup& s, const Ray& ray) {
    const auto hit = s.world->intersect(ray, RayKind::diffuse);
    if (hit) benchmark::DoNotOptimize(s.world->surface(ray, *hit));
  });
}

void world_any(benchmark::State& state, std::vector<Ray> Setup::*rays) {
  each_ray(state, rays,
           [](Setup& s, const Ray& ray) { benchmark::DoNotOptimize(s.world->occluded(ray)); });
}

/// Our own hierarchy beside bare Embree.
void tree_nearest(benchmark::State& state, std::vector<Ray> Setup::*rays) {
  each_ray(state, rays, [](Setup& s, const Ray& ray) {
    benchmark::DoNotOptimize(s.tree->nearest(ray, RayKind::diffuse, kNearest));
  });
}

void tree_any(benchmark::State& state, std::vector<Ray> Setup::*rays) {
  each_ray(state, rays,
           [](Setup& s, const Ray& ray) { benchmark::DoNotOptimize(s.tree->occluded(ray)); });
}

/// World against itself with the dragon in another role.
void world_of(benchmark::State& state, std::vector<Placement> placements) {
  Setup* s = setup();
  if (s == nullptr) return;
  GeometryCache cache;
  const auto world = *build_world(std::move(placements), cache);
  const FpMode mode;
  for (auto _ : state) {
    for (const Ray& ray : s->bounces) {
      benchmark::DoNotOptimize(world->intersect(ray, RayKind::diffuse));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(s->bounces.size()));
}

Placement far_ball() {
  Placement p;
  p.shape.kind = Shape::Kind::sphere;
  p.shape.radius = 0.01F;
  p.to_world = {moved({100.0F, 0.0F, 0.0F})};
  return p;
}

void direct_with_ball(benchmark::State& state) {
  if (setup() != nullptr) world_of(state, {place(setup()->mesh), far_ball()});
}

void identity_instance_with_ball(benchmark::State& state) {
  if (setup() == nullptr) return;
  Placement ball = far_ball();
  ball.changes_between_frames = true;
  world_of(state, {place(setup()->mesh), ball});
}

void true_instance(benchmark::State& state) {
  if (setup() == nullptr) return;
  Placement dragon = place(setup()->mesh);
  dragon.changes_between_frames = true;
  world_of(state, {dragon});
}

void moving_instance(benchmark::State& state) {
  if (setup() == nullptr) return;
  Placement dragon = place(setup()->mesh);
  dragon.to_world.push_back(moved({1e-3F, 0.0F, 0.0F}));
  world_of(state, {dragon});
}

BENCHMARK_CAPTURE(bare_nearest, primary, &Setup::primary);
BENCHMARK_CAPTURE(world_nearest, primary, &Setup::primary);
BENCHMARK_CAPTURE(bare_nearest, bounces, &Setup::bounces);
BENCHMARK_CAPTURE(world_nearest, bounces, &Setup::bounces);
BENCHMARK_CAPTURE(world_surface, bounces, &Setup::bounces);
BENCHMARK_CAPTURE(bare_nearest, inner, &Setup::inner);
BENCHMARK_CAPTURE(bare_touch, inner, &Setup::inner);
BENCHMARK_CAPTURE(world_nearest, inner, &Setup::inner);
BENCHMARK_CAPTURE(world_surface, inner, &Setup::inner);
BENCHMARK_CAPTURE(bare_any, bounces, &Setup::bounces);
BENCHMARK_CAPTURE(world_any, bounces, &Setup::bounces);
BENCHMARK_CAPTURE(tree_nearest, primary, &Setup::primary);
BENCHMARK_CAPTURE(tree_nearest, bounces, &Setup::bounces);
BENCHMARK_CAPTURE(tree_nearest, inner, &Setup::inner);
BENCHMARK_CAPTURE(tree_any, bounces, &Setup::bounces);
BENCHMARK(direct_with_ball);
BENCHMARK(identity_instance_with_ball);
BENCHMARK(true_instance);
BENCHMARK(moving_instance);

void load(benchmark::State& state, const char* name) {
  const auto files = make_file_resolver("");
  const std::string file = hyades::test::shared_file(std::string("assets/meshes/") + name);
  if (!std::filesystem::exists(file)) {
    state.SkipWithError("the shared assets are not here");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(read_mesh(*files, file));
}

BENCHMARK_CAPTURE(load, dragon_ply, "dragon_100k.ply")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(load, bunny_obj, "bunny_closed_75k.obj")->Unit(benchmark::kMillisecond);

void build(benchmark::State& state, RenderClass which) {
  Setup* s = setup();
  if (s == nullptr) return;
  for (auto _ : state) {
    GeometryCache cache;
    benchmark::DoNotOptimize(build_world({place(s->mesh)}, cache, which));
  }
}
BENCHMARK_CAPTURE(build, native, RenderClass::native)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(build, portable, RenderClass::portable)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
