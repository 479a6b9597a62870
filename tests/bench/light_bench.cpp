// Choosing among many lights: how fast, and how well at equal samples.

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "core/base/warp.h"
#include "core/lights/light_selector.h"
#include "tests/support/moments.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

/// A town: spots that look down and bare bulbs over a square plain of fixed density; all together
/// have a power of 1000 W.
std::vector<LightPtr> town(int64_t count) {
  test::Random random(5);
  std::vector<LightPtr> lights;
  const float side = std::sqrt(static_cast<float>(count));
  for (int64_t i = 0; i < count; ++i) {
    const Vec3 at(side * random.uniform(), 0.3F + random.uniform(), side * random.uniform());
    const Rgb power(1000.0F / static_cast<float>(count) * (0.2F + random.uniform()));
    if (i % 2 == 0) {
      lights.push_back(make_spot_light(at, {0, -1, 0}, power, 0.8F, 0.5F));
    } else {
      lights.push_back(make_point_light(at, power));
    }
  }
  return lights;
}

Vec3 place_in_town(int64_t count, test::Random& random) {
  const float side = std::sqrt(static_cast<float>(count));
  return {side * random.uniform(), 0.0F, side * random.uniform()};
}

const Vec3 kUp(0.0F, 1.0F, 0.0F);

void BM_LightTreeBuild(benchmark::State& state) {
  const auto lights = town(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(make_tree_selector(lights));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(BM_LightTreeBuild)->Arg(10)->Arg(1000)->Arg(100'000)->Unit(benchmark::kMillisecond);

void BM_LightTreeSelectAndProbability(benchmark::State& state) {
  const auto lights = town(state.range(0));
  const auto selector = make_tree_selector(lights);
  test::Random random(7);
  for (auto _ : state) {
    const Vec3 from = place_in_town(state.range(0), random);
    const auto chosen = selector->select(from, kUp, random.uniform());
    benchmark::DoNotOptimize(selector->probability(from, kUp, chosen->index));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_LightTreeSelectAndProbability)->Arg(1)->Arg(10)->Arg(1000)->Arg(100'000);

/// Relative error (standard deviation over mean) of the light on a facing surface, one sample each,
/// root mean square over places.
void BM_ErrorOfOneSample(benchmark::State& state) {
  const auto lights = town(state.range(0));
  const auto selector =
      state.range(1) != 0 ? make_tree_selector(lights) : make_power_selector(lights);
  test::Random random(9);
  double error = 0.0;
  for (auto _ : state) {
    double sum = 0.0;
    constexpr int kPlaces = 100;
    for (int place = 0; place < kPlaces; ++place) {
      const Vec3 from = place_in_town(state.range(0), random);
      double exact = 0.0;
      for (const LightPtr& light : lights) {
        const auto s = light->sample_direct(from, 0.0F, 0.0F, Vec2(0.5F));
        if (s) exact += static_cast<double>(luminance(s->radiance) * s->direction.y);
      }
      test::Moments moments;
      for (int i = 0; i < 2000; ++i) {
        const auto chosen = selector->select(from, kUp, random.uniform());
        const auto s = lights[chosen->index]->sample_direct(from, 0.0F, 0.0F, Vec2(0.5F));
        const float value = s ? luminance(s->radiance) * s->direction.y : 0.0F;
        const double off = static_cast<double>(value / chosen->probability) / exact - 1.0;
        moments.add(off * off);
      }
      sum += moments.mean();
    }
    error = std::sqrt(sum / kPlaces);
  }
  state.counters["relative_error"] = error;
}
BENCHMARK(BM_ErrorOfOneSample)
    ->ArgNames({"lights", "tree"})
    ->ArgsProduct({{10, 1000, 10'000}, {0, 1}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hyades::core

BENCHMARK_MAIN();
