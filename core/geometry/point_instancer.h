#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/vec.h"

namespace hyades::core {

/// Where a copy stands: an affine map, column by column.
using PlaceMatrix = glm::mat4x3;

/// Many copies of the same placements. A copy takes 48 bytes here, and as much again in Embree.
struct PointInstancer {
  std::string name;                                        ///< of the file, for messages
  std::shared_ptr<const std::vector<PlaceMatrix>> places;  ///< at least one
  /// The instancer as a whole, over the shutter interval as Placement::to_world. A copy's matrix is
  /// one of these, times its place, times Placement::to_world.
  std::vector<Mat4> to_world{Mat4(1.0F)};
};

inline Mat4 place_matrix(const PlaceMatrix& m) {
  return {Vec4(m[0], 0.0F), Vec4(m[1], 0.0F), Vec4(m[2], 0.0F), Vec4(m[3], 1.0F)};
}

}  // namespace hyades::core
