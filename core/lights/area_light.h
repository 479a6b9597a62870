#pragma once

#include <optional>

#include "core/lights/light.h"
#include "core/lights/surface_emission.h"

namespace hyades::core {

/// What all lights on surfaces have in common: light from the outer side of a surface, or from
/// both, the same in all directions or by a profile, and densities per area turned into densities
/// per solid angle.
class AreaLight : public Light {
 public:
  /// `brightness`: the integral of the emission's luminance over the surface when the shutter opens
  /// [W/sr], only for power().
  AreaLight(const SurfaceEmission& emission, double brightness);

  /// Makes all of it `factor` times as bright; before set_surface.
  void scale(float factor);

  /// Tells where the light's middle is when the shutter opens.
  void set_middle(const Vec3& middle) { middle_ = middle; }
  std::optional<Vec3> middle() const override { return middle_; }

  /// Tells where the surface is while the shutter is open, and what its outer normals are.
  void set_surface(const Bounds& box, const DirectionCone& normals);
  std::optional<LightBounds> bounds() const override { return bounds_; }

  Rgb radiance(const SurfacePoint& on, const Vec3& outward) const override;
  float power() const override { return power_; }

  /// A place as choose_place has it, a direction in proportion to its cosine with the normal, or as
  /// the profile chooses it; of two-sided lights on either side alike.
  std::optional<EmissionSample> sample_emission(float time, float pick, const Vec2& place,
                                                const Vec2& direction) const override;
  float pdf_outward(const Vec3& normal, const Vec3& outward) const override;

 protected:
  /// A place of the surface and the density per area with which it was chosen (pdf_place tells it
  /// again).
  struct Place {
    SurfacePoint on;
    float pdf = 0.0F;
  };
  virtual std::optional<Place> choose_place(float time, float pick, const Vec2& u) const = 0;

  /// What `from` gets from the place `position`, chosen with `pdf_area` per area, that rays leave
  /// freely at distance `clearance` from the surface. Nothing where it sends no light to `from`.
  /// The radiance is that of an emission that does not vary.
  std::optional<LightSample> seen_from(const Vec3& from, const Vec3& position, const Vec3& ng,
                                       float clearance, float pdf_area) const;

  /// What `from` gets from `place`, with the radiance that it has there; nothing where it sends no
  /// light to `from`.
  std::optional<LightSample> seen_from(const Vec3& from, const Place& place) const;

  /// The radiance that leaves a place with unit outer normal `ng` towards `outward`, where the
  /// emission does not vary.
  Rgb emitted(const Vec3& ng, const Vec3& outward) const;

  const SurfaceEmission& emission() const { return emission_; }
  bool is_dark() const { return power_ == 0.0F; }

 private:
  SurfaceEmission emission_;
  float power_;
  std::optional<Vec3> middle_;
  std::optional<LightBounds> bounds_;
};

/// Density per solid angle at `from` of a place that is chosen with `pdf_area` per area: multiplied
/// by distance^2 / cos; 0 where the place is seen edge-on.
float area_to_solid_angle(float pdf_area, const Vec3& from, const Vec3& position, const Vec3& ng);

}  // namespace hyades::core
