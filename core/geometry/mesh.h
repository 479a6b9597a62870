#pragma once

#include <array>
#include <cstddef>
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
  std::vector<Vec3> normals;     ///< per vertex, unit, or 0: none there; or empty: flat
  std::vector<Vec2> uvs;         ///< per vertex; or empty
  std::vector<Vec2> second_uvs;  ///< per vertex; or empty
  std::vector<Vec4> colors;      ///< per vertex, linear Rec.709 and alpha; or empty
  /// Per vertex those that the file says, for normal maps: unit x, y, z along growing u, and in w
  /// on which side growing v is: below 0 against cross(normal, tangent). Or empty.
  std::vector<Vec4> vertex_tangents;
  /// Per corner of each triangle, unit, for normal maps: see compute_tangents(). Mostly empty.
  std::vector<std::array<Vec3, 3>> tangents;
  Bounds bounds;

  size_t memory() const;  ///< bytes of vertex and index data
};

/// Reads `bounds` off the positions and reserves Embree's padding. Call after filling in.
void finish_mesh(TriangleMesh& mesh);

/// Tangents as normal maps are baked for (MikkTSpace: Mikkelsen 2008, "Simulation of Wrinkled
/// Surfaces Revisited"): the directions of growing u of all triangles that share a vertex's
/// position, normal and uv and wind alike around their uv, in the plane of the normal, weighed by
/// their angles. None for meshes without normals or uvs, whose triangles have their own. They take
/// the place of `vertex_tangents`.
void compute_tangents(TriangleMesh& mesh);

/// Angle-weighted vertex normals (Thuermer & Wuethrich 1998), unit, or 0 where there is none. With
/// `group`, the vertices that have the same number there, one of theirs, share theirs.
std::vector<Vec3> smooth_normals(const TriangleMesh& mesh, const std::vector<uint32_t>& group);

/// smooth_normals(), of each vertex by itself, for meshes that have none.
void compute_smooth_normals(TriangleMesh& mesh);

}  // namespace hyades::core
