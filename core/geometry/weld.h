#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec.h"

namespace hyades::core {

/// For each vertex the number of the first one at its position; 0 and -0 are equal.
std::vector<uint32_t> weld(const std::vector<Vec3>& positions);

/// For each vertex the number of the first one with its position and its normal, of which there are
/// as many as positions.
std::vector<uint32_t> weld(const std::vector<Vec3>& positions, const std::vector<Vec3>& normals);

}  // namespace hyades::core
