#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry/affine.h"
#include "core/geometry/mesh.h"
#include "core/geometry/shape.h"

namespace hyades::core {

/// Vertices and triangles as Embree sees a mesh: those of the mesh itself, or copies.
struct MeshBuffers {
  Shape shape;                                         ///< a mesh; says whether it deforms
  bool in_world = false;                               ///< or in the mesh's object space
  std::vector<const Vec3*> steps;                      ///< vertices at equal steps of the shutter
  const std::array<uint32_t, 3>* indices = nullptr;    ///< the mesh's triangles
  const std::array<uint32_t, 3>* triangles = nullptr;  ///< the same, degenerate ones made invalid
  std::vector<std::vector<Vec3>> own_positions;        ///< what of `steps` is no mesh's own
  std::vector<std::array<uint32_t, 3>> own_triangles;  ///< empty: the mesh's
  /// Per triangle: by how much Embree may misplace it at most [length of the buffers' space];
  /// empty where vertices move.
  std::vector<float> errors;
  Bounds bounds;  ///< of all positions

  const TriangleMesh& mesh() const { return *shape.mesh; }
  bool vertices_move() const { return steps.size() > 1; }
  size_t own_memory() const;  ///< bytes of the copies and errors

  /// The corners of a triangle at `time` where vertices move: on straight lines from step to step,
  /// which is what Embree does, and what matrices interpolated linearly do.
  std::array<Vec3d, 3> moving_corners(const std::array<uint32_t, 3>& triangle, float time) const;
};

/// Buffers of a mesh in object space (`motion` null), or in world space under `motion`. Shares the
/// mesh's memory where it can. One step where nothing moves; two where a mesh deforms and nothing
/// else does; as many as `motion` has where it keeps its form; else more, for vertices under a
/// moving matrix that move themselves do not move on straight lines.
std::shared_ptr<const MeshBuffers> make_mesh_buffers(const Shape& shape, const Motion* motion);

}  // namespace hyades::core
