#pragma once

#include <memory>

#include "core/base/vec.h"
#include "core/lights/light_bounds.h"

namespace hyades::core {

/// How the light of a surface is shared out among directions. Directions are unit and lead away
/// from the surface; normals are those of the side that they leave on. Immutable and thread-safe.
class AngularProfile {
 public:
  virtual ~AngularProfile() = default;

  /// What goes along `outward`, dot(normal, outward) > 0, of a radiance that is the same in all
  /// directions.
  virtual Rgb share(const Vec3& normal, const Vec3& outward) const = 0;

  /// A direction for u in [0, 1)^2, which may lead below the surface; with density pdf() per solid
  /// angle.
  virtual Vec3 choose(const Vec3& normal, const Vec2& u) const = 0;
  virtual float pdf(const Vec3& normal, const Vec3& outward) const = 0;

  /// What is left of the flux, as luminance.
  virtual float mean() const = 0;

  /// Narrows the directions that `bounds`, those of a surface, shines in.
  virtual void narrow(LightBounds& bounds) const = 0;
};

using ProfilePtr = std::shared_ptr<const AngularProfile>;

/// A grid of deep cells before the lamp, as of a soft box: of light at angle t from the normal
/// 1 - tan(t) / tan(spread / 2) comes through, of which all is made brighter so that the flux stays
/// what it would be without. `spread` in radians, in (0, pi]; pi, and what float cannot tell from
/// it, is no grid: null.
ProfilePtr make_spread(float spread);

}  // namespace hyades::core
