#include <utility>

#include "core/textures/make_texture.h"
#include "core/textures/mapping.h"

namespace hyades::core {
namespace {

class ScaleTexture final : public Texture {
 public:
  ScaleTexture(TexturePtr input, TexturePtr factor)
      : input_(std::move(input)), factor_(std::move(factor)) {}

  Rgb color(const TexturePoint& at) const override {
    return input_->color(at) * factor_->color(at);
  }
  float scalar(const TexturePoint& at) const override {
    return input_->scalar(at) * factor_->scalar(at);
  }
  ScalarGradient scalar_gradient(const TexturePoint& at) const override {
    const ScalarGradient a = input_->scalar_gradient(at);
    const ScalarGradient b = factor_->scalar_gradient(at);
    ScalarGradient product = weighted_sum(b.value, a, a.value, b);
    product.value = a.value * b.value;
    return product;
  }

 private:
  TexturePtr input_;
  TexturePtr factor_;
};

}  // namespace

TexturePtr make_scale_texture(TexturePtr input, TexturePtr factor) {
  return std::make_shared<ScaleTexture>(std::move(input), std::move(factor));
}

}  // namespace hyades::core
