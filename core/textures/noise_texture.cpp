#include <utility>

#include "core/textures/make_texture.h"
#include "core/textures/mapping.h"
#include "core/textures/noise.h"

namespace hyades::core {
namespace {

class NoiseTexture final : public Texture {
 public:
  NoiseTexture(TexturePtr a, TexturePtr b, const NoiseDesc& noise, const MappingDesc& mapping)
      : a_(std::move(a)), b_(std::move(b)), noise_(noise), mapping_(mapping) {}

  Rgb color(const TexturePoint& at) const override {
    const float w = weight(at).value;
    return (1.0F - w) * a_->color(at) + w * b_->color(at);
  }

  float scalar(const TexturePoint& at) const override {
    const float w = weight(at).value;
    return (1.0F - w) * a_->scalar(at) + w * b_->scalar(at);
  }

  ScalarGradient scalar_gradient(const TexturePoint& at) const override {
    const Noise3 w = weight(at);
    const ScalarGradient a = a_->scalar_gradient(at);
    const ScalarGradient b = b_->scalar_gradient(at);
    ScalarGradient result = weighted_sum(1.0F - w.value, a, w.value, b);
    add_mapped_gradient(mapping_, (b.value - a.value) * w.gradient, result);
    return result;
  }

 private:
  /// 0.5 + 0.5 noise within [0, 1] and its gradient in mapped space.
  Noise3 weight(const TexturePoint& at) const {
    const Vec3 p = map_point(mapping_, at);
    Noise3 n;
    if (noise_.dimensions == 4) {
      const Noise4 n4 = fbm(Vec4(p, noise_.time), noise_.octaves, noise_.lacunarity, noise_.gain);
      n = {n4.value, Vec3(n4.gradient)};
    } else {
      n = fbm(p, noise_.octaves, noise_.lacunarity, noise_.gain);
    }
    if (n.value <= -1.0F) return {0.0F, Vec3(0.0F)};
    if (n.value >= 1.0F) return {1.0F, Vec3(0.0F)};
    return {0.5F + 0.5F * n.value, 0.5F * n.gradient};
  }

  TexturePtr a_;
  TexturePtr b_;
  NoiseDesc noise_;
  MappingDesc mapping_;
};

}  // namespace

TexturePtr make_noise_texture(TexturePtr a, TexturePtr b, const NoiseDesc& noise,
                              const MappingDesc& mapping) {
  return std::make_shared<NoiseTexture>(std::move(a), std::move(b), noise, mapping);
}

}  // namespace hyades::core
