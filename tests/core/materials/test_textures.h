#pragma once

#include <functional>

#include "core/textures/make_texture.h"

namespace hyades::core {

/// A texture given by a function that knows its own derivatives.
class FunctionTexture final : public Texture {
 public:
  using Function = std::function<ScalarGradient(const TexturePoint&)>;
  explicit FunctionTexture(Function function) : function_(std::move(function)) {}

  Rgb color(const TexturePoint& at) const override { return Rgb(function_(at).value); }
  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const float of_grey = weights.x + weights.y + weights.z;
    const ScalarGradient f = function_(at);
    return {of_grey * f.value + weights.w, of_grey * f.d_uv, of_grey * f.d_object,
            of_grey * f.d_world};
  }

 private:
  Function function_;
};

inline TexturePtr function_texture(FunctionTexture::Function function) {
  return std::make_shared<FunctionTexture>(std::move(function));
}

/// Height that grows along `slope` in object space.
inline TexturePtr object_slope(const Vec3& slope) {
  return function_texture([slope](const TexturePoint& at) {
    ScalarGradient g;
    g.value = glm::dot(slope, at.object);
    g.d_object = slope;
    return g;
  });
}

}  // namespace hyades::core
