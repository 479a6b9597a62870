// Media that vary: what a look-up costs, how much of tracking it is, what bounds by cells gain over
// one bound, and whole paths through a cloud of hundreds of bounces.
#include <benchmark/benchmark.h>

#include <openvdb/tools/Prune.h>

#include <fstream>

#include "core/base/fp_mode.h"
#include "core/job/parse.h"
#include "core/media/grid_fields.h"
#include "core/media/make_medium.h"
#include "core/media/noise_density.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"
#include "tests/support/random.h"
#include "tests/support/temp_folder.h"
#include "tests/support/vdb_writer.h"

namespace {

using namespace hyades::core;
using hyades::test::Random;

constexpr int kSide = 128;

/// A cloud of noise; `sparse`: a few small puffs in a large box.
float cloud_at(const Vec3& p, bool sparse) {
  static const Bounds kBox{Vec3(0.0F), Vec3(1.0F)};
  static const auto kDense = [] {
    NoiseDensity noise;
    noise.scale = Vec3(3.0F);
    noise.low = 0.4F;
    noise.high = 0.6F;
    noise.fade = 0.5F;
    return make_noise_density(noise, kBox);
  }();
  static const auto kSparse = [] {
    NoiseDensity noise;
    noise.scale = Vec3(5.0F);
    noise.low = 0.62F;
    noise.high = 0.75F;
    return make_noise_density(noise, kBox);
  }();
  return (sparse ? kSparse : kDense)->at(p);
}

std::shared_ptr<const BrickGrid<float>> cloud_grid(bool sparse) {
  return std::make_shared<const BrickGrid<float>>(Vec3i(0), Vec3i(kSide - 1), [&](const Vec3i& p) {
    return cloud_at(Vec3(p) / float{kSide}, sparse);
  });
}

/// Counts how often it is looked up.
class Counting final : public DensityField {
 public:
  explicit Counting(std::shared_ptr<const DensityField> inner) : inner_(std::move(inner)) {}
  float at(const Vec3& p) const override {
    ++count;
    return inner_->at(p);
  }
  Extent over(const Bounds& box) const override { return inner_->over(box); }
  Bounds bounds() const override { return inner_->bounds(); }
  mutable int64_t count = 0;

 private:
  std::shared_ptr<const DensityField> inner_;
};

std::shared_ptr<const DensityField> field(bool sparse) {
  static const auto kDense = make_grid_density(cloud_grid(false));
  static const auto kSparse = make_grid_density(cloud_grid(true));
  return sparse ? kSparse : kDense;
}

std::shared_ptr<const Volume> volume(std::shared_ptr<const DensityField> density, int cells) {
  auto majorants = std::make_shared<const MajorantGrid>(*density, Vec3i(cells));
  return std::make_shared<const Volume>(Volume{std::move(density), majorants, nullptr, nullptr});
}

Ray any_ray(Random& random) {
  const Vec3 from(random.uniform(), random.uniform(), random.uniform());
  return {from * float{kSide}, random.direction()};
}

Vec4 any4(Random& random) {
  return {random.uniform(), random.uniform(), random.uniform(), random.uniform()};
}

/// A point of the cloud along a way, as tracking asks for.
void look_up(benchmark::State& state) {
  const FpMode mode;
  const auto density = field(false);
  Random random(1);
  std::vector<Vec3> places;
  for (int i = 0; i < 256; ++i) {
    const Ray ray = any_ray(random);
    for (int k = 0; k < 16; ++k) places.push_back(ray.at(static_cast<float>(k)));
  }
  float sum = 0.0F;
  for (auto _ : state) {
    for (const Vec3& p : places) sum += density->at(p);
  }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(places.size()));
}
BENCHMARK(look_up);

enum Kind { kTransmittance, kFlight };

/// `kind` of walks through the dense (0) or sparse (1) cloud, with bounds of cells^3 cells. The
/// optical thickness of its densest parts is `thick`, were they as wide as the box.
void walk(benchmark::State& state) {
  const FpMode mode;
  const auto density = std::make_shared<Counting>(field(state.range(1) != 0));
  const float sigma = static_cast<float>(state.range(3)) / kSide;
  const Coefficients smoke{Rgb(0.001F * sigma), Rgb(sigma), Rgb(0.0F)};
  const MediumPtr medium =
      make_varying(volume(density, static_cast<int>(state.range(2))), FieldPlace({Mat4(1.0F)}),
                   smoke, Phase::henyey_greenstein(Rgb(0.0F)));
  Random random(2);
  std::vector<std::pair<Ray, Vec4>> walks;
  for (int i = 0; i < 4096; ++i) walks.emplace_back(any_ray(random), any4(random));
  Rgb sum(0.0F);
  density->count = 0;
  for (auto _ : state) {
    for (const auto& [ray, u] : walks) {
      sum += state.range(0) == kTransmittance
                 ? medium->transmittance(ray, kInfinity, u)
                 : medium->sample(ray, kInfinity, Rgb(1.0F / 3.0F), u).weight;
    }
  }
  benchmark::DoNotOptimize(sum);
  const auto done = static_cast<double>(state.iterations()) * static_cast<double>(walks.size());
  state.SetItemsProcessed(static_cast<int64_t>(done));
  state.counters["look_ups"] = static_cast<double>(density->count) / done;
}
BENCHMARK(walk)
    ->ArgNames({"flight", "sparse", "cells", "thick"})
    ->ArgsProduct({{kTransmittance, kFlight}, {0, 1}, {1, 16}, {40, 200, 1000}});

/// Samples of a picture of a 128^3 cloud that absorbs a thousandth of what it scatters, hundreds of
/// bounces allowed, one thread.
void cloud_picture(benchmark::State& state) {
  const hyades::test::TempFolder folder;
  const auto grid = hyades::test::vdb_box<openvdb::FloatGrid>(
      "density", kSide, 1.0, {0.0, 0.0, 0.0},
      [](int i, int j, int k) { return cloud_at(Vec3(i, j, k) / float{kSide}, false); });
  openvdb::tools::pruneInactive(grid->tree());
  std::ofstream(folder.file("cloud.vdb"), std::ios::binary) << hyades::test::vdb_file({grid});
  const auto assets = make_file_resolver(folder.path().string());
  Diagnostics diagnostics;
  const Job job = parse_job(R"(
hyades: 1
name: cloud
film: {size: [640, 360], crop: [200, 60, 440, 300]}
sampling: {samples: 1, seed: 1}
integrator: {type: path, max_depth: 1000, roulette_depth: 1000}
camera: {look_from: [0, 0, 3.2], look_at: [0, 0, 0], fov: 40}
materials: {air: {type: "null"}}
media: {cloud: {albedo: 0.999, scale: 300, g: 0.6, density: {vdb: cloud.vdb}}}
objects: {box: {shape: box, size: [2, 2, 2], material: air, interior: cloud}}
lights: {sun: {type: sun, direction: [1, -1, -0.5], irradiance: 3}}
environment: {color: [0.3, 0.5, 1]}
)",
                            "bench.yaml", *assets, diagnostics);
  SceneCache cache(*assets);
  const FrameRenderer renderer(*build_scene(job, 1, cache), job, 1, {});
  uint64_t bounces = 0;
  for (auto _ : state) {
    const RenderedFrame frame =
        render_frame(renderer, render_window(job.film), job.sampling.samples, 1, {.threads = 1});
    bounces += frame.counters.bounces;
  }
  const int64_t samples = state.iterations() * 240 * 240;
  state.SetItemsProcessed(samples);
  state.counters["bounces"] = static_cast<double>(bounces) / static_cast<double>(samples);
}
BENCHMARK(cloud_picture)->Unit(benchmark::kMillisecond)->Iterations(2);

}  // namespace

BENCHMARK_MAIN();
