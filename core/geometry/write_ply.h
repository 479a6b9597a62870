#pragma once

#include "core/base/bytes.h"
#include "core/geometry/mesh.h"

namespace hyades::core {

/// A mesh as a binary little-endian PLY file with all that its vertices have, under the names that
/// read_mesh knows: x y z, nx ny nz, u v, u1 v1, red green blue alpha (floats, linear) and tx ty tz
/// tw. It is read back as the same mesh, to the last bit, but for vertices without a triangle
/// (dropped) and normals that are not of unit length. TriangleMesh::tangents are left out.
Bytes ply_bytes(const TriangleMesh& mesh);

}  // namespace hyades::core
