#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

class ConstantTexture final : public Texture {
 public:
  explicit ConstantTexture(const Rgb& value) : value_(value), scalar_(luminance(value)) {
    // A grey is a number: say exactly that one, not a sum of rounded products.
    if (value.x == value.y && value.y == value.z) scalar_ = value.x;
  }
  Rgb color(const TexturePoint& /*at*/) const override { return value_; }
  float scalar(const TexturePoint& /*at*/) const override { return scalar_; }
  ScalarGradient scalar_gradient(const TexturePoint& /*at*/) const override {
    return {.value = scalar_};
  }

 private:
  Rgb value_;
  float scalar_;
};

}  // namespace

TexturePtr make_constant_texture(const Rgb& value) {
  return std::make_shared<ConstantTexture>(value);
}

}  // namespace hyades::core
