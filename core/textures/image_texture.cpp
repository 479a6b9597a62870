#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

/// Where one coordinate falls among n texels: the two neighbours (-1: black) and the weight of the
/// second.
struct Taps {
  int first;
  int second;
  float weight;
};

/// Texel `i` of an endless row of n, as the wrap mode has it; -1 for black.
int wrap_index(int64_t i, int n, WrapMode wrap) {
  if (i >= 0 && i < n) return static_cast<int>(i);
  switch (wrap) {
    case WrapMode::clamp:
      return i < 0 ? 0 : n - 1;
    case WrapMode::black:
      return -1;
    case WrapMode::mirror: {
      const int64_t period = ((i % (2 * int64_t{n})) + 2 * int64_t{n}) % (2 * int64_t{n});
      return static_cast<int>(period < n ? period : 2 * int64_t{n} - 1 - period);
    }
    case WrapMode::repeat:
      break;
  }
  return static_cast<int>(((i % n) + n) % n);
}

/// Coordinate x in texels (texel i covers [i, i + 1)).
Taps locate(double x, int n, WrapMode wrap, TextureFilter filter) {
  const double shifted = filter == TextureFilter::bilinear ? x - 0.5 : x;
  const double floor = std::floor(shifted);
  if (!(std::fabs(floor) < 0x1p62)) return {wrap_index(0, n, wrap), wrap_index(0, n, wrap), 0.0F};
  const auto i = static_cast<int64_t>(floor);
  const int first = wrap_index(i, n, wrap);
  if (filter == TextureFilter::nearest) return {first, first, 0.0F};
  return {first, wrap_index(i + 1, n, wrap), static_cast<float>(shifted - floor)};
}

class ImageTexture final : public Texture {
 public:
  ImageTexture(std::shared_ptr<const Image> image, WrapMode wrap, TextureFilter filter,
               const Vec2& scale, const Vec2& offset)
      : image_(std::move(image)), wrap_(wrap), filter_(filter), scale_(scale), offset_(offset) {
    const int r = image_->find_channel("R");
    const int g = image_->find_channel("G");
    const int b = image_->find_channel("B");
    const int y = image_->find_channel("Y");
    if (r >= 0 && g >= 0 && b >= 0) {
      channels_ = {r, g, b};
    } else {
      const int only = y >= 0 ? y : r >= 0 ? r : 0;
      channels_ = {only, only, only};
      grey_ = true;
    }
    empty_ = image_->width <= 0 || image_->height <= 0 || image_->channels.empty();
  }

  Rgb color(const TexturePoint& at) const override {
    if (empty_) return Rgb(0.0F);
    const auto [x, y] = taps(at);
    const Rgb low = mix(texel(x.first, y.first), texel(x.second, y.first), x.weight);
    if (y.weight == 0.0F) return low;
    return mix(low, mix(texel(x.first, y.second), texel(x.second, y.second), x.weight), y.weight);
  }

  float scalar(const TexturePoint& at) const override {
    const Rgb c = color(at);
    return grey_ ? c.x : luminance(c);
  }

  ScalarGradient scalar_gradient(const TexturePoint& at) const override {
    ScalarGradient result;
    result.value = scalar(at);
    if (empty_ || filter_ == TextureFilter::nearest) return result;
    const auto [x, y] = taps(at);
    const float a = number(x.first, y.first);
    const float b = number(x.second, y.first);
    const float c = number(x.first, y.second);
    const float d = number(x.second, y.second);
    const float along = (b - a) * (1.0F - y.weight) + (d - c) * y.weight;
    const float up = (c - a) * (1.0F - x.weight) + (d - b) * x.weight;
    result.d_uv = {along * scale_.x * static_cast<float>(image_->width),
                   up * scale_.y * static_cast<float>(image_->height)};
    return result;
  }

 private:
  /// The neighbours of a point: columns from the left, rows from below.
  std::pair<Taps, Taps> taps(const TexturePoint& at) const {
    const double u = double{at.uv.x} * scale_.x + offset_.x;
    const double v = double{at.uv.y} * scale_.y + offset_.y;
    return {locate(u * image_->width, image_->width, wrap_, filter_),
            locate(v * image_->height, image_->height, wrap_, filter_)};
  }

  /// Rows counted from below, unlike the image's own.
  Rgb texel(int x, int y) const {
    if (x < 0 || y < 0) return Rgb(0.0F);
    const float* pixel = &image_->data[image_->index(x, image_->height - 1 - y, 0)];
    return {pixel[channels_[0]], pixel[channels_[1]], pixel[channels_[2]]};
  }

  float number(int x, int y) const {
    const Rgb c = texel(x, y);
    return grey_ ? c.x : luminance(c);
  }

  /// Exact where a = b: a white image stays white.
  static Rgb mix(const Rgb& a, const Rgb& b, float t) { return a + (b - a) * t; }

  std::shared_ptr<const Image> image_;
  WrapMode wrap_;
  TextureFilter filter_;
  Vec2 scale_;
  Vec2 offset_;
  std::array<int, 3> channels_{};
  bool grey_ = false;
  bool empty_ = false;
};

}  // namespace

TexturePtr make_image_texture(std::shared_ptr<const Image> image, WrapMode wrap,
                              TextureFilter filter, const Vec2& scale, const Vec2& offset) {
  return std::make_shared<ImageTexture>(std::move(image), wrap, filter, scale, offset);
}

}  // namespace hyades::core
