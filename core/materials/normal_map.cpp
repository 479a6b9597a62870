#include <cmath>
#include <memory>
#include <utility>

#include "core/geometry/mesh_attributes.h"
#include "core/materials/above_horizon.h"
#include "core/materials/params.h"
#include "core/materials/wrapped_material.h"

namespace hyades::core {
namespace {

/// The tangent is SurfacePoint::tangent, the bitangent the cross product of normal and tangent, to
/// the side of growing v, or that which the mesh's file says (Mikkelsen 2008, "Simulation of
/// Wrinkled Surfaces Revisited", section 2.4).
class NormalMap final : public WrappedMaterial {
 public:
  NormalMap(MaterialPtr base, TexturePtr normals, ScalarParam strength)
      : WrappedMaterial(std::move(base)),
        normals_(std::move(normals)),
        strength_(std::move(strength)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame& frame, BsdfArena& arena) const override {
    turn(point, frame);
    return base().bsdf_at(point, frame, arena);
  }

 private:
  void turn(const SurfacePoint& point, Frame& frame) const {
    const Rgb color = normals_->color(texture_point(point));
    const float strength = number_at(strength_, point);
    const float x = strength * (2.0F * color.x - 1.0F);
    const float y = strength * (2.0F * color.y - 1.0F);
    const Vec3 along = point.tangent != Vec3(0.0F) ? point.tangent : point.dpdu;
    const Frame tangents = Frame::around(frame.n, along);
    const bool mirrored = file_tangent_mirrored(point).value_or(
        glm::dot(glm::cross(point.dpdu, point.dpdv), point.ng) < 0.0F);
    const Vec3 n = tangents.to_world({x, mirrored ? -y : y, 2.0F * color.z - 1.0F});
    const float length2 = glm::dot(n, n);
    if (!(length2 > 0.0F) || !(length2 < kInfinity)) return;
    frame = Frame::around(above_horizon(n / std::sqrt(length2), point.ng), along);
  }

  TexturePtr normals_;
  ScalarParam strength_;
};

}  // namespace

MaterialPtr make_normal_map(MaterialPtr base, TexturePtr normals, const ScalarParam& strength) {
  return std::make_shared<NormalMap>(std::move(base), std::move(normals), strength);
}

}  // namespace hyades::core
