// How much of Embree's own speed arrives in pictures. The ceiling is 1 / (1/c + 1/o): c closest-hit
// and o occlusion queries per second of bare Embree on the very rays that the integrator casts; a
// bounce is one of each. The integrator runs through FrameRenderer::render, sampler and film on, in
// the same scene, on one thread. Rounds alternate between all of them and medians are quoted,
// because machines are noisy.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <mutex>

#include "core/base/fp_mode.h"
#include "core/base/machine.h"
#include "core/cameras/make_camera.h"
#include "core/geometry/embree.h"
#include "core/job/parse.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"

namespace {

using namespace hyades::core;

// A closed room: every path goes on until roulette or max_depth ends it, all bounces are diffuse
// and incoherent.
constexpr const char* kJob = R"(
hyades: 1
name: bench
film: {size: [256, 256], filter: box}
sampling: {samples: 16, seed: 1}
integrator: {type: path, max_depth: 8}
camera: {look_from: [4.2, 4.6, 7.2], look_at: [0, 0.1, 0], fov: 36}
materials:
  clay: {type: lambert, color: [0.8, 0.75, 0.7]}
objects:
  knot: {mesh: jobs/mesh-100k/knot.ply, material: clay}
  room: {shape: box, size: [18, 18, 18], material: clay}
  lamp: {shape: rectangle, size: [4, 4], transform: [{rotate_x: 180}], at: [0, 8.9, 0], emit: {radiance: 20}}
)";

/// A world that notes the rays it is asked for.
class RecordingWorld : public World {
 public:
  explicit RecordingWorld(std::shared_ptr<const World> inner) : inner_(std::move(inner)) {}
  std::optional<Hit> intersect(const Ray& ray, RayKind kind) const override {
    closest.push_back(ray);
    return inner_->intersect(ray, kind);
  }
  bool occluded(const Ray& ray) const override {
    shadow.push_back(ray);
    return inner_->occluded(ray);
  }
  SurfacePoint surface(const Ray& ray, const Hit& hit) const override {
    return inner_->surface(ray, hit);
  }
  bool nearest(const Ray& ray, RayKind kind, SurfacePoint& point) const override {
    closest.push_back(ray);
    return inner_->nearest(ray, kind, point);
  }
  SurfacePoint quadric_point(uint32_t o, const Vec3& near, float t) const override {
    return inner_->quadric_point(o, near, t);
  }
  SurfacePoint triangle_point(uint32_t o, uint32_t p, float u, float v, float t) const override {
    return inner_->triangle_point(o, p, u, v, t);
  }
  Mat4 transform_at(uint32_t o, float t) const override { return inner_->transform_at(o, t); }
  const Placement& placement(uint32_t o) const override { return inner_->placement(o); }
  uint32_t placement_count() const override { return inner_->placement_count(); }
  Bounds bounds() const override { return inner_->bounds(); }
  Bounds bounds_of(uint32_t o) const override { return inner_->bounds_of(o); }
  size_t memory() const override { return inner_->memory(); }
  uint64_t invalid_rays() const override { return inner_->invalid_rays(); }

  mutable std::vector<Ray> closest;
  mutable std::vector<Ray> shadow;

 private:
  std::shared_ptr<const World> inner_;
};

/// The scene as bare Embree knows it.
RTCScene bare_scene(RTCDevice device, const World& world, RTCSceneFlags flags) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, flags);
  for (uint32_t i = 0; i < world.placement_count(); ++i) {
    const Placement& placement = world.placement(i);
    const TriangleMesh& mesh = *placement.shape.mesh;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<Vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                              RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                                              mesh.positions.size()));
    for (const Vec3& p : mesh.positions) *points++ = transform_point(placement.to_world[0], p);
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            12, mesh.triangles.size());
    std::copy(mesh.triangles.begin(), mesh.triangles.end(),
              static_cast<std::array<uint32_t, 3>*>(indices));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene);
  return scene;
}

RTCRay to_embree(const Ray& ray) {
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          0.0F,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          0.0F,
          ray.t_max,
          0xFFFFFFFFU,
          0,
          0};
}

/// A sixteenth of the picture, spread over it: what is recorded and what is rendered.
std::vector<Unit> sampled_units() {
  std::vector<Unit> units;
  for (int i = 0; i < 16; ++i) {
    const int x = 16 * (i * 7 % 16);
    const int y = 16 * i;
    units.push_back({1, {x, y, x + 16, y + 16}, {0, 1}});
  }
  return units;
}

struct Setup {
  Job job;
  std::unique_ptr<AssetResolver> assets = make_file_resolver(".");
  std::unique_ptr<SceneCache> cache = std::make_unique<SceneCache>(*assets);
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<FrameRenderer> renderer;
  RTCDevice device = nullptr;
  RTCScene bare = nullptr;    ///< Embree at its fastest
  RTCScene robust = nullptr;  ///< with the flags that the renderer needs: watertight
  std::vector<Ray> closest;
  std::vector<Ray> shadow;
};

Setup& setup() {
  static Setup s = [] {
    Setup made;
    Diagnostics diagnostics;
    made.job = parse_job(kJob, "bench.yaml", *made.assets, diagnostics);
    if (!diagnostics.empty()) {
      std::fprintf(stderr, "%s\nrun the benchmark from the repository's root\n",
                   diagnostics.to_string().c_str());
      std::exit(1);
    }
    made.scene = *build_scene(made.job, 1, *made.cache);
    made.renderer = std::make_unique<FrameRenderer>(made.scene, made.job, 1, LayerSet{});
    auto recording = std::make_shared<RecordingWorld>(made.scene->world);
    const FpMode mode;
    {  // The same scene with the recorder in the world's place.
      auto copy = std::make_shared<Scene>();
      copy->world = recording;
      copy->objects = made.scene->objects;
      copy->lights = made.scene->lights;
      copy->infinite_lights = made.scene->infinite_lights;
      copy->selector = make_power_selector(copy->lights);
      copy->camera = make_perspective_camera(
          {{{4.2F, 4.6F, 7.2F}, {0.0F, 0.1F, 0.0F}, {0.0F, 1.0F, 0.0F}, 0.628F}}, {256, 256}, {});
      copy->resolution = {256, 256};
      const FrameRenderer recorder(copy, made.job, 1, {});
      for (const Unit& unit : sampled_units()) static_cast<void>(recorder.render(unit));
    }
    made.closest = std::move(recording->closest);
    made.shadow = std::move(recording->shadow);
    made.device = rtcNewDevice("isa=avx2,threads=1");
    made.bare = bare_scene(made.device, *made.scene->world, RTC_SCENE_FLAG_NONE);
    made.robust = bare_scene(made.device, *made.scene->world, RTC_SCENE_FLAG_ROBUST);
    return made;
  }();
  return s;
}

// Each returns how many operations it did.
size_t trace_closest(RTCScene scene) {
  Setup& s = setup();
  for (const Ray& ray : s.closest) {
    RTCRayHit query{};
    query.ray = to_embree(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
    benchmark::DoNotOptimize(query);
  }
  return s.closest.size();
}

size_t trace_occlusion(RTCScene scene) {
  Setup& s = setup();
  for (const Ray& ray : s.shadow) {
    RTCRay query = to_embree(ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &query);
    benchmark::DoNotOptimize(query);
  }
  return s.shadow.size();
}

size_t bare_closest() { return trace_closest(setup().bare); }
size_t bare_occlusion() { return trace_occlusion(setup().bare); }
size_t robust_closest() { return trace_closest(setup().robust); }
size_t robust_occlusion() { return trace_occlusion(setup().robust); }

size_t world_closest() {
  Setup& s = setup();
  for (const Ray& ray : s.closest)
    benchmark::DoNotOptimize(s.scene->world->intersect(ray, RayKind::diffuse));
  return s.closest.size();
}

size_t world_nearest() {
  Setup& s = setup();
  SurfacePoint point;
  for (const Ray& ray : s.closest) {
    benchmark::DoNotOptimize(s.scene->world->nearest(ray, RayKind::diffuse, point));
    benchmark::DoNotOptimize(point);
  }
  return s.closest.size();
}

size_t world_occlusion() {
  Setup& s = setup();
  for (const Ray& ray : s.shadow) benchmark::DoNotOptimize(s.scene->world->occluded(ray));
  return s.shadow.size();
}

/// The eight numbers that a bounce draws.
size_t sampler_numbers() {
  const auto sampler = make_sampler(SamplerKind::sobol);
  constexpr uint32_t kBounces = 1U << 17U;
  for (uint32_t i = 0; i < kBounces; ++i) {
    if (i % 8 == 0)
      sampler->start({1, 1, {static_cast<int>(i & 255U), static_cast<int>(i >> 8U)}, i & 15U});
    sampler->set_dimension(8 + 8 * (i % 8));
    benchmark::DoNotOptimize(sampler->next_4d());
    benchmark::DoNotOptimize(sampler->next_4d());
  }
  return kBounces;
}

/// Counts closest-hit queries, each of which ends in a bounce.
size_t render_bounces() {
  Setup& s = setup();
  size_t bounces = 0;
  for (const Unit& unit : sampled_units()) {
    const RenderedUnit rendered = s.renderer->render(unit);
    bounces += rendered.counters.samples + rendered.counters.bounces;
  }
  return bounces;
}

void run(benchmark::State& state, size_t (*work)()) {
  const FpMode mode;
  setup();
  size_t done = 0;
  for (auto _ : state) done += work();
  state.SetItemsProcessed(static_cast<int64_t>(done));
}

/// CPU seconds of one operation: other processes then disturb less than by the clock on the wall.
double seconds_each(size_t (*work)()) {
  const double begin = thread_seconds();
  const size_t done = work();
  return (thread_seconds() - begin) / static_cast<double>(done);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void print_summary() {
  const FpMode mode;
  const std::pair<const char*, size_t (*)()> parts[] = {
      {"bare Embree, closest hit", bare_closest}, {"bare Embree, occlusion", bare_occlusion},
      {"robust, closest hit", robust_closest},    {"robust, occlusion", robust_occlusion},
      {"World::intersect", world_closest},        {"World::nearest", world_nearest},
      {"World::occluded", world_occlusion},       {"the sampler's numbers", sampler_numbers},
      {"the integrator", render_bounces},
  };
  constexpr int kRounds = 41;
  std::map<std::string, std::vector<double>> times;
  for (int round = 0; round < kRounds; ++round) {
    for (const auto& [name, work] : parts) times[name].push_back(seconds_each(work));
  }
  const auto ns = [&](const char* name) { return 1e9 * median(times[name]); };
  const double shadows =
      static_cast<double>(setup().shadow.size()) / static_cast<double>(setup().closest.size());
  // Of each round, since the machine's speed may change from one to the next.
  const auto percent = [&](const char* closest, const char* occlusion) {
    std::vector<double> values;
    for (size_t i = 0; i < kRounds; ++i) {
      values.push_back(100.0 * (times[closest][i] + shadows * times[occlusion][i]) /
                       times["the integrator"][i]);
    }
    return median(values);
  };
  std::printf("\none bounce, ns (medians of %d rounds in turn):\n", kRounds);
  for (const auto& [name, work] : parts) std::printf("  %-28s %7.1f\n", name, ns(name));
  const double known =
      ns("World::nearest") + shadows * ns("World::occluded") + ns("the sampler's numbers");
  std::printf("  %-28s %7.1f  (BSDF, light, path state, film; %.2f shadow rays per bounce)\n",
              "what remains", ns("the integrator") - known, shadows);
  std::printf("the integrator: %.2f M bounces/s\n", 1e3 / ns("the integrator"));
  std::printf(
      "of the ceiling 1/(1/c + %.2f/o) of Embree as the renderer needs it, watertight: %.0f %%\n",
      shadows, percent("robust, closest hit", "robust, occlusion"));
  std::printf("of the same of Embree without RTC_SCENE_FLAG_ROBUST: %.0f %%\n",
              percent("bare Embree, closest hit", "bare Embree, occlusion"));
}

BENCHMARK_CAPTURE(run, bare_closest, bare_closest)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, bare_occlusion, bare_occlusion)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, world_closest, world_closest)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, world_nearest, world_nearest)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, world_occlusion, world_occlusion)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, sampler_numbers, sampler_numbers)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, integrator, render_bounces)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  print_summary();
  return 0;
}
