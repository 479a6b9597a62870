#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "core/base/hash.h"
#include "core/base/warp.h"
#include "core/materials/make_material.h"
#include "core/materials/shaded_surface.h"

/// What one bounce asks of a material, over directions prepared beforehand. Items are calls.
namespace hyades::core {
namespace {

constexpr size_t kInputs = 1024;

struct Input {
  Vec3 wo;
  Vec3 wi;
  float lobe;
  Vec2 u;
};

std::vector<Input> inputs() {
  std::vector<Input> all(kInputs);
  const auto number = [](size_t i, uint64_t d) {
    return static_cast<float>(hash_combine(i, d) >> 40) * 0x1p-24F;
  };
  for (size_t i = 0; i < kInputs; ++i) {
    all[i] = {square_to_cosine_hemisphere({number(i, 0), number(i, 1)}),
              square_to_cosine_hemisphere({number(i, 2), number(i, 3)}),
              number(i, 4),
              {number(i, 5), number(i, 6)}};
  }
  return all;
}

MaterialPtr material(int64_t which) {
  const auto number = [](float value) { return ScalarParam{value, nullptr}; };
  const MetalIndex gold = *find_metal("gold");
  const ColorParam color{{0.8F, 0.5F, 0.3F}, nullptr};
  switch (which) {
    case 0:
      return make_lambert(color);
    case 1:
      return make_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F));
    case 2:
      return make_rough_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(0.3F));
    case 3:
      return make_conductor(gold.eta, gold.k, number(0.0F), Rgb(1.0F));
    case 4:
      return make_conductor(gold.eta, gold.k, number(0.3F), Rgb(1.0F));
    case 5:
      return make_glossy(color, number(0.4F), number(0.7F));
    case 6:
      return make_rough_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(0.3F),
                                   FacetScattering::multiple);
    default:
      return make_mix(make_lambert(color), make_mirror(color), number(0.4F));
  }
}

const char* const kNames[] = {
    "lambert",         "dielectric", "rough dielectric",      "smooth conductor",
    "rough conductor", "glossy",     "full rough dielectric", "mix"};

template <class Call>
void per_call(benchmark::State& state, const Call& call) {
  const MaterialPtr tested = material(state.range(0));
  const std::vector<Input> all = inputs();
  const SurfacePoint point;
  BsdfArena arena;
  for (auto _ : state) {
    for (const Input& input : all) {
      arena.reset();
      const ShadedSurface surface(point, *tested, arena);
      benchmark::DoNotOptimize(call(surface, input));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kInputs));
  state.SetLabel(kNames[state.range(0)]);
}

void make_surface(benchmark::State& state) {
  per_call(state, [](const ShadedSurface& surface, const Input&) { return surface.bsdf(); });
}
BENCHMARK(make_surface)->DenseRange(0, 7);

void make_and_sample(benchmark::State& state) {
  per_call(state, [](const ShadedSurface& surface, const Input& in) {
    return surface.sample(in.wo, in.lobe, in.u, TransportMode::radiance);
  });
}
BENCHMARK(make_and_sample)->DenseRange(0, 7);

void make_and_evaluate_with_pdf(benchmark::State& state) {
  per_call(state, [](const ShadedSurface& surface, const Input& in) {
    return surface.evaluate(in.wo, in.wi, TransportMode::radiance) *
           surface.pdf(in.wo, in.wi, TransportMode::radiance);
  });
}
BENCHMARK(make_and_evaluate_with_pdf)->DenseRange(0, 7);

}  // namespace
}  // namespace hyades::core

BENCHMARK_MAIN();
