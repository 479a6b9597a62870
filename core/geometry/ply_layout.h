#pragma once

#include <array>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/ply_header.h"

namespace hyades::core {

/// What a vertex property means: its place in a row of eight floats.
enum PlySlot : int { kX, kY, kZ, kNx, kNy, kNz, kU, kV, kPlySlots, kIgnored = -1 };

using PlyRow = std::array<float, kPlySlots>;

/// Which properties of the vertices a mesh takes.
struct PlyLayout {
  std::vector<PlySlot> slots;  ///< per property
  bool has_normals = false;
  bool has_uvs = false;
};

/// Error: the vertices lack a coordinate.
Result<PlyLayout> ply_layout(const PlyElement& vertices);

}  // namespace hyades::core
