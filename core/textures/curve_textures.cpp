#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/base/elementary.h"
#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

/// A number of one variable and its slope.
struct Curve {
  float value = 0.0F;
  float slope = 0.0F;
};

/// A curve that every channel goes through.
template <class CurveAt>
class CurveTexture final : public Texture {
 public:
  CurveTexture(TexturePtr input, const CurveAt& curve) : input_(std::move(input)), curve_(curve) {}

  Rgb color(const TexturePoint& at) const override {
    const Rgb c = input_->color(at);
    return {curve_(c.x).value, curve_(c.y).value, curve_(c.z).value};
  }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const Rgb c = input_->color(at);
    float value = weights.w;
    Vec4 inner(0.0F);
    for (int i = 0; i < 3; ++i) {
      const Curve curve = curve_(c[i]);
      value += weights[i] * curve.value;
      inner[i] = weights[i] * curve.slope;
    }
    ScalarGradient result = input_->gradient(at, inner);
    result.value = value;
    return result;
  }

 private:
  TexturePtr input_;
  CurveAt curve_;
};

template <class CurveAt>
TexturePtr through(TexturePtr input, const CurveAt& curve) {
  return std::make_shared<CurveTexture<CurveAt>>(std::move(input), curve);
}

Curve smooth(float u, float scale) {
  return {u * u * (3.0F - 2.0F * u), 6.0F * u * (1.0F - u) * scale};
}

}  // namespace

TexturePtr make_invert_texture(TexturePtr input) {
  return through(std::move(input), [](float x) { return Curve{1.0F - x, -1.0F}; });
}

TexturePtr make_remap_texture(TexturePtr input, const RemapDesc& desc) {
  return through(std::move(input), [desc](float x) {
    const float width = desc.high - desc.low;
    const float scale = width != 0.0F ? 1.0F / width : 0.0F;
    // Where nothing lies between low and high, it is a step.
    const float u = width != 0.0F ? (x - desc.low) * scale : (x < desc.low ? 0.0F : 1.0F);
    Curve part{u, scale};
    if (desc.ends != RemapEnds::open) {
      if (u <= 0.0F) {
        part = {0.0F, 0.0F};
      } else if (u >= 1.0F) {
        part = {1.0F, 0.0F};
      } else if (desc.ends == RemapEnds::smooth) {
        part = smooth(u, scale);
      }
    }
    const float range = desc.to_high - desc.to_low;
    return Curve{desc.to_low + range * part.value, range * part.slope};
  });
}

TexturePtr make_power_texture(TexturePtr input, float exponent) {
  return through(std::move(input), [exponent](float x) {
    if (!(x > 0.0F)) return Curve{exponent == 0.0F ? 1.0F : 0.0F, 0.0F};
    const float value = pow(x, exponent);
    return Curve{value, exponent * value / x};
  });
}

TexturePtr make_threshold_texture(TexturePtr input, float level, float softness) {
  const float low = level - 0.5F * softness;
  return through(std::move(input), [low, softness](float x) {
    if (x < low) return Curve{0.0F, 0.0F};
    if (x >= low + softness) return Curve{1.0F, 0.0F};
    return smooth((x - low) / softness, 1.0F / softness);
  });
}

}  // namespace hyades::core
