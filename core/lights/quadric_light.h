#pragma once

#include <cstdint>
#include <optional>

#include "core/geometry/world.h"
#include "core/lights/area_light.h"

namespace hyades::core {

/// A sphere, disk or cylinder under any affine transform, chosen by area of the untransformed shape
/// (disks: that is by area; others: by area where the scale is uniform). The density accounts for
/// how much the transform stretches each place, so it is exact in any case. Where the emission
/// varies, brighter places are chosen more often.
class QuadricLight : public AreaLight {
 public:
  /// `area` when the shutter opens.
  QuadricLight(const World& world, uint32_t object, const SurfaceEmission& emission, double area);

  std::optional<LightSample> sample_direct(const Vec3& from, float time, float pick,
                                           const Vec2& u) const override;
  float pdf_direct(const Vec3& from, const Vec3& direction, const SurfacePoint& on) const override;
  float pdf_place(const SurfacePoint& on, const Vec3& direction) const override;

 protected:
  std::optional<Place> choose_place(float time, float pick, const Vec2& u) const override;
  const Shape& shape() const { return shape_; }
  Mat4 to_world(float time) const { return moves_ ? world_.transform_at(object_, time) : first_; }
  Place place_at(float time, const Vec2& u) const;

  /// The place next to `near` (object space), where the emission varies.
  Place place_near(const Vec3& near, float time) const;

 private:
  QuadricLight(const World& world, uint32_t object, const SurfaceEmission& emission, double area,
               BrightnessGrid bright);

  const World& world_;
  uint32_t object_;
  const Shape& shape_;
  bool moves_;
  Mat4 first_;             ///< to world, when the shutter opens
  BrightnessGrid bright_;  ///< over what is mapped to the shape; empty: does not vary
};

/// SurfacePoint::clearance of a place on a quadric with unit normal `ng`: what rounding its
/// coordinates to float may move it along the normal, twice.
float quadric_clearance(const Vec3& position, const Vec3& ng);

/// A sphere that is chosen by the solid angle it covers, wherever it is seen from outside and its
/// transform keeps it round (half of the time only, where its emission varies); a QuadricLight
/// otherwise.
class SphereLight : public QuadricLight {
 public:
  using QuadricLight::QuadricLight;

  std::optional<LightSample> sample_direct(const Vec3& from, float time, float pick,
                                           const Vec2& u) const override;
  float pdf_direct(const Vec3& from, const Vec3& direction, const SurfacePoint& on) const override;
};

}  // namespace hyades::core
