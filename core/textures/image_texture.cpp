#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

constexpr int kMostTaps = 16;  ///< of an anisotropic look-up

/// Exact where a = b: a white image stays white.
Vec4 mix(const Vec4& a, const Vec4& b, float t) { return a + (b - a) * t; }

/// Red, green, blue and alpha, and how they change along u and v.
struct Texel {
  Vec4 value{0.0F};
  Vec4 d_u{0.0F};
  Vec4 d_v{0.0F};
};

Texel mix(const Texel& a, const Texel& b, float t) {
  return {mix(a.value, b.value, t), mix(a.d_u, b.d_u, t), mix(a.d_v, b.d_v, t)};
}

template <TexelFormat format>
Vec4 read(const Texels& level, const Taps& x, const Taps& y) {
  const Vec4 low =
      mix(level.texel<format>(x.first, y.first), level.texel<format>(x.second, y.first), x.weight);
  if (y.weight == 0.0F) return low;
  return mix(low,
             mix(level.texel<format>(x.first, y.second), level.texel<format>(x.second, y.second),
                 x.weight),
             y.weight);
}

template <TexelFormat format>
Texel read_slopes(const Texels& level, const Taps& x, const Taps& y) {
  const Vec4 a = level.texel<format>(x.first, y.first);
  const Vec4 b = level.texel<format>(x.second, y.first);
  const Vec4 c = level.texel<format>(x.first, y.second);
  const Vec4 d = level.texel<format>(x.second, y.second);
  return {read<format>(level, x, y),
          mix(b - a, d - c, y.weight) * static_cast<float>(level.width()),
          mix(c - a, d - b, x.weight) * static_cast<float>(level.height())};
}

/// log2(x) of a positive x, straight between powers of two: at most 0.09 too small.
float rough_log2(float x) {
  const auto bits = std::bit_cast<uint32_t>(x);
  return static_cast<float>(static_cast<int32_t>(bits >> 23U) - 127) +
         static_cast<float>(bits & 0x7FFFFFU) * 0x1p-23F;
}

/// What a pixel covers of an image, in its own coordinates.
struct Footprint {
  Vec2 along{0.0F};     ///< of several places that are read, from the first to the last
  float width2 = 0.0F;  ///< squared width of each [texels of the image]
  int taps = 1;
};

class ImageTexture final : public Texture {
 public:
  ImageTexture(PyramidPtr image, ImageTextureDesc desc)
      : image_(std::move(image)), desc_(std::move(desc)) {}

  Rgb color(const TexturePoint& at) const override { return Rgb(look_up(at)); }

  float alpha(const TexturePoint& at) const override { return look_up(at).w; }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    if (image_->levels().empty()) return {};
    if (desc_.filter == TextureFilter::nearest) return {.value = glm::dot(weights, look_up(at))};
    const MappedPoint mapped(desc_.mapping, at);
    const Texel texel = over_footprint<Texel>(mapped, at);
    ScalarGradient result{.value = glm::dot(weights, texel.value)};
    mapped.add_gradient({glm::dot(weights, texel.d_u), glm::dot(weights, texel.d_v), 0.0F}, result);
    return result;
  }

 private:
  Vec4 look_up(const TexturePoint& at) const {
    if (image_->levels().empty()) return Vec4(0.0F);
    return over_footprint<Vec4>(MappedPoint(desc_.mapping, at), at);
  }

  /// Value is Vec4, or Texel where slopes are wanted too.
  template <class Value>
  Value over_footprint(const MappedPoint& mapped, const TexturePoint& at) const {
    const Vec2 uv(mapped.coordinate());
    const bool sized =
        desc_.filter == TextureFilter::trilinear || desc_.filter == TextureFilter::anisotropic;
    if (!sized || !desc_.view || at.surface == nullptr || at.finest) return in_level<Value>(0, uv);
    const Footprint footprint = footprint_of(mapped, *at.surface);
    Value sum = in_sizes<Value>(footprint.width2, uv + footprint.along * offset_of(0, footprint));
    for (int i = 1; i < footprint.taps; ++i) {
      const Value next =
          in_sizes<Value>(footprint.width2, uv + footprint.along * offset_of(i, footprint));
      sum = mix(sum, next, 1.0F / static_cast<float>(i + 1));
    }
    return sum;
  }

  /// Of tap i from the middle, as a part of the way.
  static float offset_of(int i, const Footprint& footprint) {
    return (static_cast<float>(i) + 0.5F) / static_cast<float>(footprint.taps) - 0.5F;
  }

  Footprint footprint_of(const MappedPoint& mapped, const SurfacePoint& surface) const {
    const PixelCone cone = desc_.view->pixel_at(surface.position, surface.time);
    const PixelSpan span = span_on_surface(cone, surface.ng);
    const Vec2 a(mapped.step(span.major, surface));
    const Vec2 b(mapped.step(span.minor, surface));
    const Vec2 size(image_->levels()[0].width(), image_->levels()[0].height());
    float longest2 = length2(a * size);
    float shortest2 = length2(b * size);
    Footprint footprint{a, 0.0F, 1};
    if (shortest2 > longest2) {
      std::swap(longest2, shortest2);
      footprint.along = b;
    }
    footprint.width2 = longest2;
    if (desc_.filter == TextureFilter::trilinear || !(longest2 > 1.0F)) return footprint;
    // As many as there are widths in the length; what more would be needed makes them wider.
    const float ratio = std::sqrt(longest2 / std::max(shortest2, 1.0F));
    footprint.taps = static_cast<int>(std::min(static_cast<float>(kMostTaps), ratio + 0.5F));
    const auto parts = static_cast<float>(footprint.taps);
    footprint.width2 = longest2 / (parts * parts);
    return footprint;
  }

  static float length2(const Vec2& v) { return glm::dot(v, v); }

  /// Between the two levels whose texels are about as wide as wanted.
  template <class Value>
  Value in_sizes(float width2, const Vec2& uv) const {
    const auto last = static_cast<float>(image_->levels().size() - 1);
    if (!(width2 > 1.0F)) return in_level<Value>(0, uv);
    const float level = 0.5F * rough_log2(width2);
    if (!(level < last)) return in_level<Value>(image_->levels().size() - 1, uv);
    const float floor = std::floor(level);
    const auto finer = static_cast<size_t>(floor);
    return mix(in_level<Value>(finer, uv), in_level<Value>(finer + 1, uv), level - floor);
  }

  template <class Value>
  Value in_level(size_t index, const Vec2& uv) const {
    const Texels& level = image_->levels()[index];
    switch (level.format()) {
      case TexelFormat::bytes:
        return in_level<Value, TexelFormat::bytes>(level, uv);
      case TexelFormat::words:
        return in_level<Value, TexelFormat::words>(level, uv);
      case TexelFormat::halves:
        return in_level<Value, TexelFormat::halves>(level, uv);
      case TexelFormat::floats:
        break;
    }
    return in_level<Value, TexelFormat::floats>(level, uv);
  }

  template <class Value, TexelFormat format>
  Value in_level(const Texels& level, const Vec2& uv) const {
    const bool between = desc_.filter != TextureFilter::nearest;
    const WrapModes wrap = image_->wrap();
    const Taps x = locate(double{uv.x} * level.width(), level.width(), wrap.u, between);
    const Taps y = locate(double{uv.y} * level.height(), level.height(), wrap.v, between);
    if constexpr (std::is_same_v<Value, Texel>) {
      return read_slopes<format>(level, x, y);
    } else {
      return read<format>(level, x, y);
    }
  }

  PyramidPtr image_;
  ImageTextureDesc desc_;
};

}  // namespace

TexturePtr make_image_texture(PyramidPtr image, const ImageTextureDesc& desc) {
  return std::make_shared<ImageTexture>(std::move(image), desc);
}

}  // namespace hyades::core
