#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/bounds.h"
#include "core/base/vec.h"

namespace hyades::core {

/// Triangles in object space. Indices are in range and positions finite: loaders make sure.
/// Degenerate triangles may be present; rays miss them.
struct TriangleMesh {
  std::string name;  ///< file or description, for messages
  std::vector<Vec3>
      positions;  ///< allocated with room for one more element: Embree reads 16 bytes at the last
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<Vec3> normals;  ///< per vertex, unit, or 0: none there; or empty: flat
  std::vector<Vec2> uvs;      ///< per vertex; or empty
  Bounds bounds;

  size_t memory() const;  ///< bytes of vertex and index data
};

/// Reads `bounds` off the positions and reserves Embree's padding. Call after filling in.
void finish_mesh(TriangleMesh& mesh);

/// Angle-weighted vertex normals (Thuermer & Wuethrich 1998), for meshes that have none.
void compute_smooth_normals(TriangleMesh& mesh);

}  // namespace hyades::core
