#pragma once

#include <memory>
#include <vector>

#include "core/cameras/camera.h"

namespace hyades::core {

/// A camera's state at one moment. Not every kind of camera has all of it.
struct CameraPose {
  Vec3 from{0.0F, 0.0F, 5.0F};
  Vec3 at{0.0F};
  Vec3 up{0.0F, 1.0F, 0.0F};
  float fov = 0.7F;             ///< perspective: vertical, radians
  float lens_radius = 0.0F;     ///< 0 = pinhole (not of panoramas)
  float focus_distance = 1.0F;  ///< along the view axis (not of panoramas)
  /// Perspective: by how much of its width and height the picture moves to the right and up in the
  /// film's plane; what is parallel to the film stays as it is.
  Vec2 shift{0.0F};
  float height = 2.0F;  ///< orthographic: of what the picture shows
};

/// The opening of a lens. `blades` < 3: round, else a regular polygon turned by `rotation` [rad].
struct ApertureShape {
  int blades = 0;
  float rotation = 0.0F;
};

/// Cameras for films of `resolution`, with `poses` at equal steps over the shutter interval (at
/// least one), interpolated between.

/// Thin lens (pinhole where lens_radius is 0).
std::unique_ptr<Camera> make_perspective_camera(std::vector<CameraPose> poses, Vec2i resolution,
                                                ApertureShape aperture);

/// Parallel rays from the plane through `from`; nothing behind it is seen. With a lens, the rays of
/// each place of the lens are parallel to each other and meet those of the others in the plane of
/// focus.
std::unique_ptr<Camera> make_orthographic_camera(std::vector<CameraPose> poses, Vec2i resolution,
                                                 ApertureShape aperture);

/// Everything around `from`: columns are azimuths, rows are angles from `up`, at even steps, as
/// images of environment maps have them. `at` is in the middle column, `up` is exactly up.
std::unique_ptr<Camera> make_equirectangular_camera(std::vector<CameraPose> poses,
                                                    Vec2i resolution);

}  // namespace hyades::core
