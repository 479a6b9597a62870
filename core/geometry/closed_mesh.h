#pragma once

#include <cstddef>

#include "core/geometry/mesh.h"

namespace hyades::core {

/// Whether a mesh has an inside.
struct MeshClosure {
  /// Edges with more triangles on one side of them than on the other, corners at equal positions
  /// taken as one: those of holes, and those between triangles that face opposite ways.
  size_t open_edges = 0;
  /// The volume of its inside, in object space; below 0 where its normals point inwards. Means
  /// little where it is open.
  double volume = 0.0;

  /// It is closed, but its normals point inwards.
  bool inside_out() const { return open_edges == 0 && volume < 0.0; }
};

MeshClosure examine_closure(const TriangleMesh& mesh);

}  // namespace hyades::core
