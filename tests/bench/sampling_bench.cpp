#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/distribution.h"
#include "core/base/elementary.h"
#include "core/base/hash.h"
#include "core/base/warp.h"
#include "core/samplers/filter.h"
#include "core/samplers/independent_sampler.h"
#include "core/samplers/sobol_sampler.h"
#include "core/textures/noise.h"

/// What the innermost loops are made of, each over inputs prepared beforehand. Items are
/// evaluations (for samplers: numbers), so items_per_second is what to read.
namespace hyades::core {
namespace {

constexpr size_t kInputs = 4096;

std::vector<Vec4> inputs(float low, float high) {
  std::vector<Vec4> x(kInputs);
  for (size_t i = 0; i < kInputs; ++i) {
    for (int d = 0; d < 4; ++d) {
      const auto u = static_cast<float>(hash_combine(i, static_cast<uint64_t>(d)) >> 40) * 0x1p-24F;
      x[i][d] = low + (high - low) * u;
    }
  }
  return x;
}

template <class Function>
void evaluate(benchmark::State& state, float low, float high, const Function& f) {
  const std::vector<Vec4> x = inputs(low, high);
  for (auto _ : state) {
    for (const Vec4& v : x) benchmark::DoNotOptimize(f(v));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kInputs));
}

#define HYADES_EVALUATE(name, low, high, expression)                      \
  void name(benchmark::State& state) {                                    \
    evaluate(state, low, high, [](const Vec4& v) { return expression; }); \
  }                                                                       \
  BENCHMARK(name)

HYADES_EVALUATE(elementary_sin_cos, 0.0F, 6.28F, sin_cos(v.x));
HYADES_EVALUATE(elementary_tan, 0.0F, 6.28F, tan(v.x));
HYADES_EVALUATE(elementary_asin, -1.0F, 1.0F, asin(v.x));
HYADES_EVALUATE(elementary_acos, -1.0F, 1.0F, acos(v.x));
HYADES_EVALUATE(elementary_atan2, -1.0F, 1.0F, atan2(v.x, v.y));
HYADES_EVALUATE(elementary_exp, -10.0F, 2.0F, exp(v.x));
HYADES_EVALUATE(elementary_expm1, -10.0F, 2.0F, expm1(v.x));
HYADES_EVALUATE(elementary_log, 0.0F, 2.0F, log(v.x));
HYADES_EVALUATE(elementary_log1p, 0.0F, 2.0F, log1p(v.x));
HYADES_EVALUATE(elementary_exp2, -10.0F, 2.0F, exp2(v.x));
HYADES_EVALUATE(elementary_log2, 0.0F, 2.0F, log2(v.x));
HYADES_EVALUATE(elementary_pow, 0.0F, 2.0F, pow(v.x, v.y));
HYADES_EVALUATE(elementary_cbrt, -2.0F, 2.0F, cbrt(v.x));
HYADES_EVALUATE(warp_disk, 0.0F, 1.0F, square_to_disk(Vec2(v)));
HYADES_EVALUATE(warp_cosine_hemisphere, 0.0F, 1.0F, square_to_cosine_hemisphere(Vec2(v)));
HYADES_EVALUATE(warp_uniform_sphere, 0.0F, 1.0F, square_to_uniform_sphere(Vec2(v)));
HYADES_EVALUATE(warp_cone, 0.0F, 1.0F, square_to_cone(Vec2(v), 0.1F));
HYADES_EVALUATE(noise_perlin3, -50.0F, 50.0F, perlin(Vec3(v)));
HYADES_EVALUATE(noise_perlin4, -50.0F, 50.0F, perlin(v));
HYADES_EVALUATE(noise_fbm4_of_4_octaves, -50.0F, 50.0F, fbm(v, 4, 2.0F, 0.5F));

/// `state.range(0)` numbers per sample, 64 samples per pixel, through the concrete class.
template <class Concrete>
void numbers(benchmark::State& state) {
  const auto count = static_cast<int>(state.range(0));
  Concrete sampler;
  SampleId id;
  for (auto _ : state) {
    id.pixel.x = static_cast<int>(id.sample >> 6);
    sampler.start(id);
    float sum = 0.0F;
    for (int d = 0; d < count; d += 2) {
      const Vec2 u = sampler.next_2d();
      sum += u.x + u.y;
    }
    benchmark::DoNotOptimize(sum);
    ++id.sample;
  }
  state.SetItemsProcessed(state.iterations() * count);
}
BENCHMARK(numbers<SobolSampler>)->Name("sampler_sobol")->Arg(8)->Arg(64);
BENCHMARK(numbers<IndependentSampler>)->Name("sampler_independent")->Arg(8)->Arg(64);

/// The same through the interface, as an integrator sees it.
void virtual_numbers(benchmark::State& state) {
  const auto sampler = make_sampler(SamplerKind::sobol);
  SampleId id;
  for (auto _ : state) {
    sampler->start(id);
    float sum = 0.0F;
    for (int d = 0; d < 64; d += 2) {
      const Vec2 u = sampler->next_2d();
      sum += u.x + u.y;
    }
    benchmark::DoNotOptimize(sum);
    ++id.sample;
  }
  state.SetItemsProcessed(state.iterations() * 64);
}
BENCHMARK(virtual_numbers)->Name("sampler_sobol_virtual");

void filters(benchmark::State& state) {
  const auto filter = make_pixel_filter(static_cast<FilterShape>(state.range(0)), 1.5F);
  evaluate(state, 0.0F, 1.0F, [&](const Vec4& v) { return filter->sample(Vec2(v)); });
}
BENCHMARK(filters)->Name("filter_box")->Arg(static_cast<int>(FilterShape::box));
BENCHMARK(filters)
    ->Name("filter_blackman_harris")
    ->Arg(static_cast<int>(FilterShape::blackman_harris));

void choices(benchmark::State& state) {
  std::vector<float> weights(static_cast<size_t>(state.range(0)));
  for (size_t i = 0; i < weights.size(); ++i) weights[i] = static_cast<float>(mix64(i) >> 40);
  const Distribution1D distribution(weights);
  evaluate(state, 0.0F, 1.0F, [&](const Vec4& v) { return distribution.sample(v.x); });
}
BENCHMARK(choices)->Name("distribution_1d")->Arg(16)->Arg(4096)->Arg(1 << 20);

void points(benchmark::State& state) {
  const auto width = static_cast<uint32_t>(state.range(0));
  std::vector<float> weights(size_t{width} * width / 2);
  for (size_t i = 0; i < weights.size(); ++i) weights[i] = static_cast<float>(mix64(i) >> 40);
  const Distribution2D distribution(weights, width, width / 2);
  evaluate(state, 0.0F, 1.0F, [&](const Vec4& v) { return distribution.sample(Vec2(v)); });
}
BENCHMARK(points)->Name("distribution_2d")->Arg(64)->Arg(2048);

}  // namespace
}  // namespace hyades::core

BENCHMARK_MAIN();
