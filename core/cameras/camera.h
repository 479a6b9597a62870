#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/ray.h"
#include "core/base/vec.h"

namespace hyades::core {

/// How a camera sees a place through one place of its lens.
struct CameraConnection {
  Vec3 position{0.0F};   ///< on the lens
  Vec3 direction{0.0F};  ///< unit, from there to the place
  float distance = 0.0F;
  Vec2 film{0.0F};       ///< where on the film it is seen; may lie outside the frame
  float density = 0.0F;  ///< Camera::film_density of the direction
};

/// Turns film positions into rays. Immutable and thread-safe; belongs to one frame.
class Camera {
 public:
  virtual ~Camera() = default;

  /// The ray through film position `film` (pixels of the full frame, y down, the first pixel's
  /// centre is (0.5, 0.5)), lens sample `lens` in [0, 1)^2, at shutter time `time` (0..1).
  /// Direction is unit.
  virtual Ray generate(const Vec2& film, const Vec2& lens, float time) const = 0;

  /// How the camera sees `point` through the place of the lens that generate() has for `lens`.
  /// Nothing where it lies behind.
  virtual std::optional<CameraConnection> connect(const Vec3& point, const Vec2& lens,
                                                  float time) const = 0;

  /// Film area per solid angle of rays in `direction` (unit) from one place of the lens
  /// [pixels / sr]: the density of generate()'s directions where film positions have density 1 per
  /// pixel. 0 behind.
  virtual float film_density(const Vec3& direction, float time) const = 0;

  /// Depth of a world-space point along the view axis at shutter time `time` (the depth layer).
  virtual float depth_of(const Vec3& point, float time) const = 0;
};

/// A perspective camera's state at one moment.
struct CameraPose {
  Vec3 from{0.0F, 0.0F, 5.0F};
  Vec3 at{0.0F};
  Vec3 up{0.0F, 1.0F, 0.0F};
  float fov = 0.7F;             ///< vertical, radians
  float lens_radius = 0.0F;     ///< 0 = pinhole
  float focus_distance = 1.0F;  ///< along the view axis
};

/// Thin lens (pinhole where lens_radius is 0). `poses` at equal steps over the shutter interval (at
/// least one), interpolated between. `blades` < 3: round aperture, else a regular polygon turned by
/// `blade_rotation` [rad].
std::unique_ptr<Camera> make_perspective_camera(std::vector<CameraPose> poses, Vec2i resolution,
                                                int blades, float blade_rotation);

}  // namespace hyades::core
