#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/distribution.h"
#include "core/geometry/world.h"
#include "core/lights/area_light.h"

namespace hyades::core {

/// Areas of a mesh's triangles in world space when the shutter opens, and their sum.
struct MeshAreas {
  std::vector<float> triangles;
  double total = 0.0;
};

/// A mesh that gives off light: a triangle in proportion to its area when the shutter opens (where
/// the emission varies times its mean brightness, with an even part as in BrightnessGrid), then a
/// place uniformly within it. Where the mesh moves or deforms, the density counts the triangle's
/// area of the moment.
class MeshLight : public AreaLight {
 public:
  MeshLight(const World& world, uint32_t object, const SurfaceEmission& emission,
            const MeshAreas& areas);

  std::optional<LightSample> sample_direct(const Vec3& from, float time, float pick,
                                           const Vec2& u) const override;
  float pdf_direct(const Vec3& from, const Vec3& direction, const SurfacePoint& on) const override;
  float pdf_place(const SurfacePoint& on, const Vec3& direction) const override;

 protected:
  std::optional<Place> choose_place(float time, float pick, const Vec2& u) const override;

 private:
  /// How triangles are chosen, and the integral of brightness.
  struct Brightness {
    std::vector<float> weights;
    double total = 0.0;
  };
  static Brightness measure(const World& world, uint32_t object, const SurfaceEmission& emission,
                            const MeshAreas& areas);
  MeshLight(const World& world, uint32_t object, const SurfaceEmission& emission,
            const Brightness& bright);

  float pdf_area(uint32_t triangle, float time) const;

  const World& world_;
  uint32_t object_;
  Distribution1D triangles_;
  Mat4 matrix_;  ///< to world, when the shutter opens
  bool moves_;
};

/// Area of a triangle of a mesh at shutter time `time` under the linear map `linear`.
double triangle_area(const Shape& shape, uint32_t triangle, float time, const Mat3& linear);

}  // namespace hyades::core
