#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

/// A number and its derivatives by red, green and blue.
struct Dual {
  float value = 0.0F;
  Vec3 slope{0.0F};
};

Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
Dual operator*(const Dual& a, const Dual& b) {
  return {a.value * b.value, a.value * b.slope + b.value * a.slope};
}
Dual operator*(float a, const Dual& b) { return {a * b.value, a * b.slope}; }
Dual operator/(const Dual& a, const Dual& b) {
  const float value = a.value / b.value;
  return {value, (a.slope - value * b.slope) / b.value};
}
Dual constant(float value) { return {value, Vec3(0.0F)}; }

/// How far a hue (0..6) is from a channel's own: 0 where the channel is at its greatest, 1 where it
/// is at its least.
Dual distance_from(Dual hue, float of_channel) {
  hue.value -= of_channel;
  hue.value -= 6.0F * std::floor(hue.value / 6.0F);  // 0..6
  if (hue.value > 3.0F) hue = constant(6.0F) - hue;  // 0..3
  if (hue.value <= 1.0F) return constant(0.0F);
  if (hue.value >= 2.0F) return constant(1.0F);
  return hue - constant(1.0F);
}

class Hue final : public Texture {
 public:
  Hue(TexturePtr input, const HueDesc& desc) : input_(std::move(input)), desc_(desc) {}

  Rgb color(const TexturePoint& at) const override {
    const Rgb c = input_->color(at);
    const std::array<Dual, 3> out = turned(c);
    return {out[0].value, out[1].value, out[2].value};
  }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const std::array<Dual, 3> out = turned(input_->color(at));
    Dual sum = constant(weights.w);
    for (int c = 0; c < 3; ++c) sum = sum + weights[c] * out[static_cast<size_t>(c)];
    ScalarGradient result = input_->gradient(at, Vec4(sum.slope, 0.0F));
    result.value = sum.value;
    return result;
  }

 private:
  /// Smith 1978, "Color Gamut Transform Pairs": the hexcone of hue, saturation and value.
  std::array<Dual, 3> turned(const Rgb& c) const {
    const std::array<Dual, 3> in = {Dual{c.x, {1.0F, 0.0F, 0.0F}}, Dual{c.y, {0.0F, 1.0F, 0.0F}},
                                    Dual{c.z, {0.0F, 0.0F, 1.0F}}};
    size_t most = 0;
    size_t least = 0;
    for (size_t i = 1; i < 3; ++i) {
      if (in[i].value > in[most].value) most = i;
      if (in[i].value <= in[least].value) least = i;
    }
    const Dual chroma = in[most] - in[least];
    if (!(chroma.value > 0.0F)) {
      return {desc_.value * in[0], desc_.value * in[1], desc_.value * in[2]};
    }
    // Two units per channel; the two others say how far it is turned.
    Dual hue = (in[(most + 1) % 3] - in[(most + 2) % 3]) / chroma;
    hue.value += 2.0F * static_cast<float>(most) + desc_.hue / 60.0F;
    Dual range = desc_.saturation * chroma;  // saturation times value, at most the value
    if (range.value > in[most].value) range = in[most];
    std::array<Dual, 3> out;
    for (size_t i = 0; i < 3; ++i) {
      out[i] = desc_.value * (in[most] - range * distance_from(hue, 2.0F * static_cast<float>(i)));
    }
    return out;
  }

  TexturePtr input_;
  HueDesc desc_;
};

}  // namespace

TexturePtr make_hue_texture(TexturePtr input, const HueDesc& desc) {
  return std::make_shared<Hue>(std::move(input), desc);
}

}  // namespace hyades::core
