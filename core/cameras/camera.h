#pragma once

#include <optional>
#include <vector>

#include "core/base/ray.h"
#include "core/base/vec.h"
#include "core/textures/pixel_view.h"

namespace hyades::core {

/// How a camera sees a place through one place of its lens.
struct CameraConnection {
  Vec3 position{0.0F};   ///< on the lens: where generate()'s ray to the place begins
  Vec3 direction{0.0F};  ///< unit, from there to the place
  float distance = 0.0F;
  Vec2 film{0.0F};  ///< where on the film it is seen; may lie outside the frame
  /// Film area per area across `direction` at the place [pixels / m^2].
  double across = 0.0;
};

/// Turns film positions into rays. Immutable and thread-safe; belongs to one frame.
///
/// All rays through one place of the lens begin in one point and differ in direction, or, where
/// rays_are_parallel(), have one direction and differ in where they begin.
class Camera : public PixelView {
 public:
  /// The ray through film position `film` (pixels of the full frame, y down, the first pixel's
  /// centre is (0.5, 0.5)), lens sample `lens` in [0, 1)^2, at shutter time `time` (0..1).
  /// Direction is unit.
  virtual Ray generate(const Vec2& film, const Vec2& lens, float time) const = 0;

  /// How the camera sees `point` through the place of the lens that generate() has for `lens`.
  /// Nothing where it lies behind.
  virtual std::optional<CameraConnection> connect(const Vec3& point, const Vec2& lens,
                                                  float time) const = 0;

  /// Whether the rays through one place of the lens are parallel.
  virtual bool rays_are_parallel() const { return false; }

  /// The density of generate()'s rays through one place of the lens where film positions have
  /// density 1 per pixel: film area per solid angle around `direction` (unit) [pixels / sr], or,
  /// where they are parallel, per area across them [pixels / m^2]; then `direction` is that of a
  /// ray. 0 behind.
  virtual float film_density(const Vec3& direction, float time) const = 0;

  /// Depth of a world-space point at shutter time `time` (the depth layer): along the view axis, of
  /// panoramas the distance.
  virtual float depth_of(const Vec3& point, float time) const = 0;

  /// Adds all places of the film between `lower` and `upper` (neither included) whose rays are
  /// those of `film`: that place itself, but panoramas go on beyond their edges with what they have
  /// elsewhere.
  virtual void add_places(const Vec2& film, const Vec2& lower, const Vec2& upper,
                          std::vector<Vec2>& places) const {
    if (film.x > lower.x && film.x < upper.x && film.y > lower.y && film.y < upper.y)
      places.push_back(film);
  }
};

}  // namespace hyades::core
