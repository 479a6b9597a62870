#pragma once

#include <vector>

#include "core/job/animated.h"

namespace hyades::core {

/// One step of a transform list; steps apply top to bottom.
struct TransformStep {
  enum class Kind { translate, scale, rotate_x, rotate_y, rotate_z, rotate, quaternion, matrix };
  Kind kind = Kind::translate;
  Animated<Vec3> vector{Vec3(0.0F)};  ///< translate [length]; scale [factor per axis]; rotate: axis
  Animated<float> angle{0.0F};        ///< degrees
  Animated<Vec4> quaternion{Vec4(0.0F, 0.0F, 0.0F, 1.0F)};  ///< x, y, z, w; see rotation_at
  Mat4 matrix{1.0F};                                        ///< matrix only
};
using TransformList = std::vector<TransformStep>;

}  // namespace hyades::core
