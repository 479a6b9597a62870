#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/obj_parser.h"

namespace hyades::core {

/// The vertices that face corners make: one for each (v, vt, vn) that is used.
struct ObjVertices {
  std::vector<uint32_t> of_corner;  ///< each corner's vertex
  std::vector<uint32_t> first;      ///< each vertex's first corner; they grow
};

/// Numbers the vertices of `corners` in the order of their first use, in parallel and the same way
/// whatever the number of threads. `part_ends` (ascending, the last one the number of corners)
/// cuts the corners into parts that share no vertices, so that those of a part have numbers without
/// a gap. `positions`: above all v. Fewer than 2^32 corners. Time n log n however often a position
/// is used.
ObjVertices number_vertices(const std::vector<ObjCorner>& corners, size_t positions,
                            std::span<const size_t> part_ends);

}  // namespace hyades::core
