#pragma once

#include <vector>

#include "core/base/distribution.h"
#include "core/geometry/world.h"
#include "core/lights/area_light.h"

namespace hyades::core {

/// A mesh that gives off light: a triangle in proportion to its area when the shutter opens, then a
/// place uniformly within it. Where the mesh moves, the density counts the triangle's area of the
/// moment.
class MeshLight : public AreaLight {
 public:
  /// `areas` of the triangles in world space when the shutter opens, and their sum.
  MeshLight(const World& world, uint32_t object, const Rgb& radiance, bool two_sided,
            const std::vector<float>& areas, double total);

  std::optional<LightSample> sample_direct(const Vec3& from, float time, float pick,
                                           const Vec2& u) const override;
  float pdf_direct(const Vec3& from, const Vec3& direction, const SurfacePoint& on) const override;
  float pdf_place(const SurfacePoint& on, const Vec3& direction) const override;

 protected:
  std::optional<Place> choose_place(float time, float pick, const Vec2& u) const override;

 private:
  float pdf_area(uint32_t triangle, float time) const;

  const World& world_;
  uint32_t object_;
  Distribution1D triangles_;
  Mat4 matrix_;  ///< to world, when the shutter opens
  bool moves_;
};

/// Area of a triangle under the linear map `linear`.
double triangle_area(const TriangleMesh& mesh, uint32_t triangle, const Mat3& linear);

}  // namespace hyades::core
