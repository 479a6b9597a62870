#pragma once

#include <cstdint>
#include <functional>

#include "core/base/distribution.h"
#include "core/geometry/surface_point.h"
#include "core/lights/angular_profile.h"
#include "core/materials/make_material.h"
#include "core/textures/texture.h"

namespace hyades::core {

/// What the surface of a lamp gives off, from place to place: a radiance, times a texture's colour,
/// times what there is of the surface; and how that is shared out among directions.
struct SurfaceEmission {
  Rgb radiance{0.0F};      ///< where texture and opacity are 1 [W/(m^2 sr)]
  bool two_sided = false;  ///< from the inner side too
  /// Null: 1. Images are read as finely as they can be, so that what a lamp lights does not depend
  /// on who looks at it; negative values and NaN count as black, at most 1e15 is seen.
  TexturePtr texture = nullptr;
  /// Whose opacity counts, as paths that meet the surface see it. Null: 1.
  MaterialPtr cutout = nullptr;
  /// How much of it goes where; null: the same to all sides.
  ProfilePtr profile = nullptr;
  /// About how often texture and opacity are looked up to find out where the lamp is bright.
  uint32_t look_ups = 1U << 18U;

  /// Whether it may differ from place to place.
  bool varies() const { return texture != nullptr || cutout != nullptr; }

  /// What `radiance` is multiplied by at `on`, of which uv, world_to_object and what opacity maps
  /// need count.
  Rgb share(const SurfacePoint& on) const;

  /// Luminance of what is given off at `on`.
  double brightness(const SurfacePoint& on) const;
};

/// A density on the unit square that follows a brightness: constant in each cell of a grid, in
/// proportion to the cell's mean, of which a sixteenth is spread evenly, for what lies between the
/// places that were looked at. Immutable and thread-safe.
class BrightnessGrid {
 public:
  BrightnessGrid() = default;

  /// `brightness` of a place in [0, 1)^2, not negative, is asked for up to about `look_ups` times:
  /// at 2 x 2 places of each of n x n cells, 8 <= n <= 256.
  BrightnessGrid(const std::function<double(const Vec2&)>& brightness, uint32_t look_ups);

  /// A place for u in [0, 1)^2.
  Vec2 sample(const Vec2& u) const { return cells_.sample(u).at; }

  /// The density of sample(); for places a little outside that at the edge.
  float pdf(const Vec2& at) const;

  /// The mean brightness that was found.
  double mean() const { return mean_; }

 private:
  Distribution2D cells_;
  double mean_ = 0.0;
};

/// The part of weights that is spread evenly, as in BrightnessGrid.
inline constexpr double kEvenPart = 1.0 / 16.0;

}  // namespace hyades::core
