#include <cmath>
#include <memory>
#include <utility>

#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

/// Whether floor(x) is odd; from 2^24 on all floats are even integers or so close together that no
/// pattern is left.
bool odd_cell(float x) {
  const float half = 0.5F * std::floor(x);
  return half != std::floor(half);
}

class CheckerTexture final : public Texture {
 public:
  CheckerTexture(TexturePtr a, TexturePtr b, const MappingDesc& mapping)
      : a_(std::move(a)), b_(std::move(b)), mapping_(mapping) {}

  Rgb color(const TexturePoint& at) const override { return cell(at).color(at); }
  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    ScalarGradient result = cell(at).gradient(at, Vec4(Vec3(weights), 0.0F));  // alpha is 1
    result.value += weights.w;
    return result;
  }

 private:
  const Texture& cell(const TexturePoint& at) const {
    Vec3 p = MappedPoint(mapping_, at).coordinate();
    if (mapping_.flat()) p.z = 0.0F;
    return odd_cell(p.x) != (odd_cell(p.y) != odd_cell(p.z)) ? *b_ : *a_;
  }

  TexturePtr a_;
  TexturePtr b_;
  MappingDesc mapping_;
};

}  // namespace

TexturePtr make_checker_texture(TexturePtr a, TexturePtr b, const MappingDesc& mapping) {
  return std::make_shared<CheckerTexture>(std::move(a), std::move(b), mapping);
}

}  // namespace hyades::core
