#pragma once

#include "core/base/bytes.h"
#include "core/geometry/mesh.h"

namespace hyades::core {

/// A binary little-endian PLY file of a mesh: x y z, nx ny nz and u v of its vertices, as far as it
/// has them, and its triangles. read_mesh() reads the same mesh from it.
Bytes ply_bytes(const TriangleMesh& mesh);

}  // namespace hyades::core
