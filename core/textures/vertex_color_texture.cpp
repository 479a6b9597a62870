#include <array>
#include <cstddef>
#include <memory>

#include "core/geometry/mesh_attributes.h"
#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

/// What the mesh's file says at its vertices, interpolated.
class VertexColorTexture final : public Texture {
 public:
  Rgb color(const TexturePoint& at) const override { return Rgb(value(at)); }
  float alpha(const TexturePoint& at) const override { return value(at).w; }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    ScalarGradient result;
    result.value = glm::dot(value(at), weights);
    if (at.surface == nullptr) return result;
    const std::array<Vec4, 3> by_place = vertex_color_gradient(*at.surface);
    for (int i = 0; i < 3; ++i)
      result.d_object[i] = glm::dot(by_place[static_cast<size_t>(i)], weights);
    return result;
  }

 private:
  static Vec4 value(const TexturePoint& at) {
    const Vec4 white(1.0F);
    return at.surface != nullptr ? vertex_color(*at.surface).value_or(white) : white;
  }
};

}  // namespace

TexturePtr make_vertex_color_texture() { return std::make_shared<VertexColorTexture>(); }

}  // namespace hyades::core
