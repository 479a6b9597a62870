#include <cmath>
#include <utility>

#include "core/textures/make_texture.h"
#include "core/textures/mapping.h"

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
  float scalar(const TexturePoint& at) const override { return cell(at).scalar(at); }
  ScalarGradient scalar_gradient(const TexturePoint& at) const override {
    return cell(at).scalar_gradient(at);
  }

 private:
  const Texture& cell(const TexturePoint& at) const {
    Vec3 p = map_point(mapping_, at);
    if (mapping_.mapping == Mapping::uv) p.z = 0.0F;
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
