#pragma once

#include "core/base/vec.h"

namespace hyades::core {

/// Where a camera's picture has its right, its top and its middle: orthonormal, right-handed.
struct CameraAxes {
  Vec3 right{1.0F, 0.0F, 0.0F};
  Vec3 up{0.0F, 1.0F, 0.0F};
  Vec3 forward{0.0F, 0.0F, -1.0F};
};

/// `v` scaled to unit length, or zero where it has no direction. Works for any finite length.
Vec3 unit_or_zero(const Vec3& v);

/// The axes of a camera that looks along `view` with `up` (any lengths) on top as far as that goes.
/// One that looks nowhere looks along -z. Where `up` says nothing, straight down has -z on top and
/// straight up has +z, so that +x stays on the right as for a camera that looks ahead.
CameraAxes axes_along(const Vec3& view, const Vec3& up);

/// The axes of a camera that stands upright: `up` is up exactly (+y where it has no direction), and
/// the middle lies where `view` points, seen from above; where that says nothing, at -z, else +x.
CameraAxes axes_upright(const Vec3& view, const Vec3& up);

}  // namespace hyades::core
