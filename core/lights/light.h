#pragma once

#include <cstdint>
#include <optional>

#include "core/base/vec.h"
#include "core/geometry/surface_point.h"

namespace hyades::core {

/// Light arriving at a reference point from a chosen place of a light.
struct LightSample {
  Rgb radiance{0.0F};     ///< arriving, if nothing is in between; of delta lights: irradiance on a
                          ///< facing surface
  float pdf = 0.0F;       ///< per solid angle at the reference point; delta lights: 1
  Vec3 direction{0.0F};   ///< unit, from the reference point towards the light
  float distance = 0.0F;  ///< to the light; kInfinity for sun and environment
  Vec3 position{0.0F};    ///< finite lights: of the place, moved off its surface as by
                          ///< offset_position, so that a shadow ray may go all the way
  bool delta = false;     ///< no BSDF sample can find it: no MIS
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
  /// among lights.
  virtual float power() const = 0;

  virtual bool is_infinite() const { return false; }
};

}  // namespace hyades::core
