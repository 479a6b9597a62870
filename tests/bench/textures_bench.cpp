#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/hash.h"
#include "core/textures/make_texture.h"

/// Look-ups of images and patterns, at places all over. Items are look-ups.
namespace hyades::core {
namespace {

constexpr size_t kInputs = 4096;

Vec3 place(size_t i, float low, float high) {
  Vec3 p;
  for (int d = 0; d < 3; ++d) {
    const auto u = static_cast<float>(hash_combine(i, static_cast<uint64_t>(d)) >> 40) * 0x1p-24F;
    p[d] = low + (high - low) * u;
  }
  return p;
}

/// A pixel that is as wide everywhere, seen at a slant of 5 to 1.
class EvenView final : public PixelView {
 public:
  explicit EvenView(float width) : width_(width) {}
  PixelCone pixel_at(const Vec3& /*point*/, float /*time*/) const override {
    return {Vec3(0.98058068F, 0.0F, -0.19611614F), width_};
  }

 private:
  float width_;
};

/// 8-bit colour of range(0) texels a side; what is covered is range(1) hundredths of a texel wide.
void image(benchmark::State& state, TextureFilter filter) {
  const auto side = static_cast<int>(state.range(0));
  Image picture = make_image(side, side, {"R", "G", "B"});
  for (size_t i = 0; i < picture.data.size(); ++i)
    picture.data[i] = static_cast<float>(mix64(i) >> 56) / 255.0F;
  TexelStore store;
  ImageTextureDesc desc;
  desc.filter = filter;
  const float texels = static_cast<float>(state.range(1)) * 0.01F;
  desc.view = std::make_shared<EvenView>(texels / static_cast<float>(side) / kSpanPerPixel);
  const auto texture =
      make_image_texture(*ImagePyramid::make(picture, WrapMode::repeat, store), desc);
  std::vector<SurfacePoint> points(kInputs);
  for (size_t i = 0; i < kInputs; ++i) {
    points[i].position = place(i, 0.0F, 3.0F);
    points[i].uv = Vec2(points[i].position);
  }
  for (auto _ : state) {
    for (const SurfacePoint& p : points) {
      benchmark::DoNotOptimize(texture->color({p.uv, p.position, p.position, &p}));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kInputs));
}
BENCHMARK_CAPTURE(image, nearest, TextureFilter::nearest)->Args({1024, 400});
BENCHMARK_CAPTURE(image, bilinear, TextureFilter::bilinear)->Args({1024, 400});
BENCHMARK_CAPTURE(image, trilinear, TextureFilter::trilinear)->Args({1024, 10})->Args({1024, 400});
BENCHMARK_CAPTURE(image, anisotropic, TextureFilter::anisotropic)
    ->Args({1024, 10})
    ->Args({1024, 400});

void pattern(benchmark::State& state, const PatternPtr& tested) {
  std::vector<Vec3> places;
  for (size_t i = 0; i < kInputs; ++i) places.push_back(place(i, -50.0F, 50.0F));
  for (auto _ : state) {
    for (const Vec3& p : places) benchmark::DoNotOptimize(tested->at(p));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(kInputs));
}

const FractalDesc kSpace{.octaves = 4, .time = std::nullopt};
const FractalDesc kTime{.octaves = 4, .time = 0.3F};
BENCHMARK_CAPTURE(pattern, fbm3d, make_fractal_pattern(FractalKind::fbm, kSpace));
BENCHMARK_CAPTURE(pattern, fbm4d, make_fractal_pattern(FractalKind::fbm, kTime));
BENCHMARK_CAPTURE(pattern, turbulence3d, make_fractal_pattern(FractalKind::turbulence, kSpace));
BENCHMARK_CAPTURE(pattern, turbulence4d, make_fractal_pattern(FractalKind::turbulence, kTime));
BENCHMARK_CAPTURE(pattern, ridged3d, make_fractal_pattern(FractalKind::ridged, kSpace));
BENCHMARK_CAPTURE(pattern, marble3d, make_marble_pattern(kSpace, 1.0F));
BENCHMARK_CAPTURE(pattern, wood3d, make_wood_pattern(kSpace, 1.0F));
BENCHMARK_CAPTURE(pattern, cellular3d, make_cellular_pattern({}));
BENCHMARK_CAPTURE(pattern, cellular4d, make_cellular_pattern({.time = 0.3F}));
BENCHMARK_CAPTURE(pattern, brick, make_brick_pattern(0.1F, 0.5F, 0.2F));

}  // namespace
}  // namespace hyades::core

BENCHMARK_MAIN();
