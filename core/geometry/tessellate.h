#pragma once

#include <cstddef>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/mesh.h"

namespace hyades::core {

/// About how many triangles tessellate() makes of `mesh`, told before any is made.
double estimate_tessellation(const TriangleMesh& mesh, float max_edge);

/// Halves edges that are longer than `max_edge` (above 0), again and again, and triangles with them
/// ("red-green": two, three or four of each, by how many of its edges are halved). Whether an edge
/// is halved, and where, depends on the positions of its ends alone, so that triangles which share
/// those stay without a gap between them, whatever uv or normals they have there. uvs,
/// colours and normals are interpolated, the latter kept unit, `along` too: one more unit vector of
/// each vertex. Tangents are dropped. Error: more than `budget` triangles; `mesh` is then of no
/// use. Memory is asked for only within that budget.
Status tessellate(TriangleMesh& mesh, std::vector<Vec3>& along, float max_edge, size_t budget);

}  // namespace hyades::core
