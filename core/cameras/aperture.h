#pragma once

#include <algorithm>

#include "core/base/warp.h"
#include "core/cameras/make_camera.h"

namespace hyades::core {

/// A place in an aperture of radius 1, uniform for uniform `u`.
inline Vec2 place_in(const ApertureShape& aperture, const Vec2& u) {
  return aperture.blades < 3 ? square_to_disk(u)
                             : square_to_polygon(u, aperture.blades, aperture.rotation);
}

/// A thin lens of a pose: where it is sharp, and how large it is.
struct ThinLens {
  explicit ThinLens(const CameraPose& pose) {
    // A focus distance that is not positive means nothing: everything is sharp.
    if (!(pose.focus_distance > 0.0F)) return;
    radius = std::max(pose.lens_radius, 0.0F);
    inverse_focus = 1.0F / pose.focus_distance;
  }

  /// The place on it that `u` chooses; its middle where it has no size.
  Vec2 place(const ApertureShape& aperture, const Vec2& u) const {
    return radius > 0.0F ? radius * place_in(aperture, u) : Vec2(0.0F);
  }

  float radius = 0.0F;
  float inverse_focus = 0.0F;  ///< 0: sharp everywhere, or at infinity
};

}  // namespace hyades::core
