#pragma once

#include "core/scene/scene.h"

namespace hyades::core {

/// The bodies around `point` at shutter time `time`, found by following a ray from there: those
/// whose surface it meets first from within.
MediumStack media_around(const Scene& scene, const Vec3& point, float time);

/// The bodies that `ray`, one of the camera's, begins in: those around the middle of the lens when
/// the shutter opens, but of a camera whose rays are parallel, so begin all over the picture, those
/// around its origin.
MediumStack bodies_around_lens(const Scene& scene, const Ray& ray);

}  // namespace hyades::core
