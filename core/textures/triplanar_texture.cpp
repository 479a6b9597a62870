#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "core/textures/make_texture.h"

namespace hyades::core {
namespace {

class Triplanar final : public Texture {
 public:
  Triplanar(std::array<TexturePtr, 3> planes, const MappingDesc& mapping, float blend)
      : planes_(std::move(planes)),
        space_(mapping.space),
        transform_(mapping.transform),
        // A corner's normal has 0.577 along every axis: one of them always counts.
        least_((1.0F - blend) * 0.57F) {}

  Rgb color(const TexturePoint& at) const override {
    const Vec3 w = weights_at(at);
    Rgb sum(0.0F);
    for (int i = 0; i < 3; ++i) {
      if (w[i] > 0.0F) sum += w[i] * plane(i).color(at);
    }
    return sum;
  }

  float alpha(const TexturePoint& at) const override {
    const Vec3 w = weights_at(at);
    float sum = 0.0F;
    for (int i = 0; i < 3; ++i) {
      if (w[i] > 0.0F) sum += w[i] * plane(i).alpha(at);
    }
    return sum;
  }

  ScalarGradient gradient(const TexturePoint& at, const Vec4& weights) const override {
    const Vec3 w = weights_at(at);
    ScalarGradient sum;
    for (int i = 0; i < 3; ++i) {
      if (w[i] > 0.0F) sum = weighted_sum(1.0F, sum, w[i], plane(i).gradient(at, weights));
    }
    return sum;
  }

 private:
  const Texture& plane(int axis) const { return *planes_[static_cast<size_t>(axis)]; }

  /// The shares of the planes across x, y and z. A plane's three weights of a flat side are 1, 0, 0
  /// exactly.
  Vec3 weights_at(const TexturePoint& at) const {
    if (at.surface == nullptr) return Vec3(1.0F / 3.0F);
    // Normals go as the cofactors of what points go by.
    Mat3 m(transform_);
    if (space_ == MappingSpace::object) m = m * Mat3(at.surface->world_to_object);
    const Vec3& n = at.surface->ns;
    Vec3 normal =
        n.x * glm::cross(m[1], m[2]) + n.y * glm::cross(m[2], m[0]) + n.z * glm::cross(m[0], m[1]);
    const float length = std::sqrt(glm::dot(normal, normal));
    if (!(length > 0.0F)) return Vec3(1.0F / 3.0F);
    normal = glm::max(glm::abs(normal / length) - least_, Vec3(0.0F));
    normal *= normal;
    return normal / (normal.x + normal.y + normal.z);
  }

  std::array<TexturePtr, 3> planes_;
  MappingSpace space_;
  Mat4 transform_;
  float least_;
};

}  // namespace

Mat4 plane_across(int axis) {
  const Vec3 x(1.0F, 0.0F, 0.0F);
  const Vec3 y(0.0F, 1.0F, 0.0F);
  const Vec3 z(0.0F, 0.0F, 1.0F);
  // Rows: what u, v and the depth are made of.
  const std::array<Mat3, 3> rows = {Mat3(-z, y, x), Mat3(x, -z, y), Mat3(x, y, z)};
  return Mat4(glm::transpose(rows[static_cast<size_t>(axis)]));
}

TexturePtr make_triplanar_texture(std::array<TexturePtr, 3> planes, const MappingDesc& mapping,
                                  float blend) {
  return std::make_shared<Triplanar>(std::move(planes), mapping, blend);
}

}  // namespace hyades::core
