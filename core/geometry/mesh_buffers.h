#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry/affine.h"
#include "core/geometry/mesh.h"

namespace hyades::core {

/// Vertices and triangles as Embree sees a mesh: those of the mesh itself, or copies.
struct MeshBuffers {
  std::shared_ptr<const TriangleMesh> mesh;
  bool in_world = false;                               ///< or in the mesh's object space
  const Vec3* positions = nullptr;                     ///< at the first step
  const std::array<uint32_t, 3>* indices = nullptr;    ///< the mesh's triangles
  const std::array<uint32_t, 3>* triangles = nullptr;  ///< the same, degenerate ones made invalid
  std::vector<std::vector<Vec3>> own_positions;        ///< per step; empty: the mesh's
  std::vector<std::array<uint32_t, 3>> own_triangles;  ///< empty: the mesh's
  /// Per triangle: by how much Embree may misplace it at most [length of the buffers' space];
  /// empty where vertices move.
  std::vector<float> errors;
  Bounds bounds;  ///< of all positions

  size_t own_memory() const;  ///< bytes of the copies and errors

  /// The corners of a triangle at `time` where there are several steps: in world space vertices
  /// move on straight lines from step to step, which is what matrices interpolated linearly do.
  std::array<Vec3d, 3> moving_corners(const std::array<uint32_t, 3>& triangle, const Motion& motion,
                                      float time) const;
};

/// Buffers in object space (`motion` null), or in world space under `motion`: one set of vertices
/// per step. Shares the mesh's memory where it can.
std::shared_ptr<const MeshBuffers> make_mesh_buffers(std::shared_ptr<const TriangleMesh> mesh,
                                                     const Motion* motion);

}  // namespace hyades::core
