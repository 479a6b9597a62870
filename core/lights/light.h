#pragma once

#include <cstdint>
#include <optional>

#include "core/base/vec.h"
#include "core/geometry/surface_point.h"
#include "core/lights/light_bounds.h"

namespace hyades::core {

/// Light arriving at a reference point from a chosen place of a light.
struct LightSample {
  Rgb radiance{0.0F};      ///< arriving, if nothing is in between; of delta lights: irradiance on a
                           ///< facing surface
  float pdf = 0.0F;        ///< per solid angle at the reference point; delta lights: 1
  Vec3 direction{0.0F};    ///< unit, from the reference point towards the light
  float distance = 0.0F;   ///< to the light; kInfinity for sun and environment
  Vec3 position{0.0F};     ///< finite lights: of the place, moved off its surface as by
                           ///< offset_position, so that a shadow ray may go all the way
  bool delta = false;      ///< no BSDF sample can find it: no MIS
  Vec3 normal{0.0F};       ///< unit, of the place's surface; zero where it has none
  float pdf_place = 1.0F;  ///< Light::pdf_place of the place; infinite lights: `pdf`
};

/// Light that leaves a chosen place in a chosen direction: where a light path begins.
struct EmissionSample {
  SurfacePoint on;  ///< the place; of lights without a surface position and time, and no normal
  Vec3 direction{0.0F};        ///< unit
  Rgb weight{0.0F};            ///< radiance times cosine over both densities [W]
  float pdf_place = 0.0F;      ///< per area; 1 where the light is a single place
  float pdf_direction = 0.0F;  ///< per solid angle
};

/// Something that gives off light. Immutable and thread-safe; belongs to one frame.
class Light {
 public:
  virtual ~Light() = default;

  /// Chooses a place of the light as seen from `from` at shutter time `time`. `pick` chooses among
  /// parts (triangles), `u` within one; all in [0, 1). Nothing where no light can arrive.
  virtual std::optional<LightSample> sample_direct(const Vec3& from, float time, float pick,
                                                   const Vec2& u) const = 0;

  /// Density per solid angle at `from` with which sample_direct chooses `on`, a point of this
  /// light's surface. Infinite lights: `direction` is what counts and `on` is ignored. Delta
  /// lights: 0.
  virtual float pdf_direct(const Vec3& from, const Vec3& direction,
                           const SurfacePoint& on) const = 0;

  /// Radiance that leaves `on` (a point of this light's surface) towards unit `outward`. Infinite
  /// lights: radiance arriving from the direction -outward.
  virtual Rgb radiance(const SurfacePoint& on, const Vec3& outward) const = 0;

  /// Total flux in W as luminance (infinite lights: through a disc around the world), for choosing
  /// among lights; of a sky that is chosen by its excess, the flux of that. 0: never to be chosen.
  virtual float power() const = 0;

  virtual bool is_infinite() const { return false; }

  /// Where the light is and shines, whatever the shutter time: outside of that it sends no light.
  /// Nothing for infinite lights and those without power.
  virtual std::optional<LightBounds> bounds() const { return std::nullopt; }

  /// About where the light is, for choosing places near it. Nothing for infinite lights.
  virtual std::optional<Vec3> middle() const { return std::nullopt; }

  /// Whether no ray can find it: a single place or direction.
  virtual bool is_delta() const { return false; }

  /// Chooses a place and a direction in which light leaves it at shutter time `time`; as in
  /// sample_direct `pick` chooses among parts. Nothing where none leaves. Finite lights only: of
  /// infinite ones sample_direct gives the direction.
  virtual std::optional<EmissionSample> sample_emission(float time, float pick, const Vec2& place,
                                                        const Vec2& direction) const = 0;

  /// Density per area with which sample_emission chooses `on`, a point of this light's surface.
  /// Infinite lights: of a direction, as pdf_direct. Delta lights: 1.
  virtual float pdf_place(const SurfacePoint& on, const Vec3& direction) const = 0;

  /// Density per solid angle with which sample_emission chooses unit `outward` at a place whose
  /// outer normal is `normal`. Finite lights only.
  virtual float pdf_outward(const Vec3& normal, const Vec3& outward) const = 0;
};

}  // namespace hyades::core
