#include <cmath>
#include <memory>
#include <utility>

#include "core/materials/above_horizon.h"
#include "core/materials/params.h"
#include "core/materials/wrapped_material.h"

namespace hyades::core {
namespace {

/// Blinn 1978, "Simulation of Wrinkled Surfaces": the point moves to p + h ns, so its tangents
/// become dpdu + h_u ns and dpdv + h_v ns (the terms in h are dropped: h is small against the
/// radius of curvature), and their cross product is the new normal.
class Bump final : public WrappedMaterial {
 public:
  Bump(MaterialPtr base, TexturePtr height, float scale, ScalarParam strength)
      : WrappedMaterial(std::move(base)),
        height_(std::move(height)),
        scale_(scale),
        strength_(std::move(strength)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame& frame, BsdfArena& arena) const override {
    const ScalarGradient h = height_->scalar_gradient(texture_point(point));
    const float h_u = scale_ * (h.d_uv.x + along(h, point, point.dpdu));
    const float h_v = scale_ * (h.d_uv.y + along(h, point, point.dpdv));
    turn(point, h_u, h_v, number_at(strength_, point), frame);
    return base().bsdf_at(point, frame, arena);
  }

 private:
  /// Change of height per unit of the parameter whose tangent is `tangent`, through space.
  static float along(const ScalarGradient& h, const SurfacePoint& point, const Vec3& tangent) {
    const Vec3 object = transform_vector(point.world_to_object, tangent);
    return glm::dot(h.d_object, object) + glm::dot(h.d_world, tangent);
  }

  static void turn(const SurfacePoint& point, float h_u, float h_v, float strength, Frame& frame) {
    const Vec3 ns = frame.n;
    // Tangents of an interpolated normal's surface are perpendicular to it.
    const Vec3 tangent_u = point.dpdu - glm::dot(point.dpdu, ns) * ns;
    const Vec3 tangent_v = point.dpdv - glm::dot(point.dpdv, ns) * ns;
    Vec3 n = glm::cross(tangent_u + h_u * ns, tangent_v + h_v * ns);
    const float length2 = glm::dot(n, n);
    if (!(length2 > 0.0F) || !(length2 < kInfinity)) return;
    n /= std::sqrt(length2);
    if (glm::dot(n, ns) < 0.0F) n = -n;
    if (strength != 1.0F) {
      n = ns + strength * (n - ns);
      const float mixed2 = glm::dot(n, n);
      if (!(mixed2 > 0.0F)) return;
      n /= std::sqrt(mixed2);
    }
    frame = Frame::around(above_horizon(n, point.ng), point.dpdu);
  }

  TexturePtr height_;
  float scale_;
  ScalarParam strength_;
};

}  // namespace

MaterialPtr make_bump(MaterialPtr base, TexturePtr height, float scale,
                      const ScalarParam& strength) {
  return std::make_shared<Bump>(std::move(base), std::move(height), scale, strength);
}

}  // namespace hyades::core
