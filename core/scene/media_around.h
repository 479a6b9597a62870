#pragma once

#include "core/scene/scene.h"

namespace hyades::core {

/// The bodies around `point` at shutter time `time`, found by following a ray from there: those
/// whose surface it meets first from within.
MediumStack media_around(const Scene& scene, const Vec3& point, float time);

}  // namespace hyades::core
