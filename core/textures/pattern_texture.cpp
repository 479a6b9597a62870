#include <memory>
#include <utility>

#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

class PatternTexture final : public Texture {
 public:
  PatternTexture(TexturePtr a, TexturePtr b, PatternPtr pattern, const MappingDesc& mapping)
      : a_(std::move(a)), b_(std::move(b)), pattern_(std::move(pattern)), mapping_(mapping) {}

  Rgb color(const TexturePoint& at) const override {
    const float w = pattern_->at(MappedPoint(mapping_, at).coordinate()).value;
    if (w == 0.0F) return a_->color(at);
    if (w == 1.0F) return b_->color(at);
    return (1.0F - w) * a_->color(at) + w * b_->color(at);
  }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const MappedPoint mapped(mapping_, at);
    const Noise3 w = pattern_->at(mapped.coordinate());
    const Vec4 colors(Vec3(weights), 0.0F);  // alpha is 1
    const ScalarGradient a = a_->gradient(at, colors);
    const ScalarGradient b = b_->gradient(at, colors);
    ScalarGradient result = weighted_sum(1.0F - w.value, a, w.value, b);
    mapped.add_gradient((b.value - a.value) * w.gradient, result);
    result.value += weights.w;
    return result;
  }

 private:
  TexturePtr a_;
  TexturePtr b_;
  PatternPtr pattern_;
  MappingDesc mapping_;
};

}  // namespace

TexturePtr make_pattern_texture(TexturePtr a, TexturePtr b, PatternPtr pattern,
                                const MappingDesc& mapping) {
  return std::make_shared<PatternTexture>(std::move(a), std::move(b), std::move(pattern), mapping);
}

}  // namespace hyades::core
