#include <memory>

#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

class ConstantTexture final : public Texture {
 public:
  explicit ConstantTexture(const Rgb& value) : value_(value) {}
  Rgb color(const TexturePoint& /*at*/) const override { return value_; }
  ScalarGradient gradient(const TexturePoint& /*at*/, const Vec4& weights) const override {
    return {.value = glm::dot(weights, Vec4(value_, 1.0F))};
  }

 private:
  Rgb value_;
};

}  // namespace

TexturePtr make_constant_texture(const Rgb& value) {
  return std::make_shared<ConstantTexture>(value);
}

}  // namespace hyades::core
