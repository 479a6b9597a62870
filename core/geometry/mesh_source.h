#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/mesh.h"
#include "core/geometry/read_mesh.h"

namespace hyades::core {

/// Polygons as a file lists them: the corners of all, one after the other.
struct PolygonList {
  std::vector<uint32_t> corners;
  std::vector<uint32_t> sizes;
};

/// Polygons beyond this many corners are refused: cutting them takes quadratic time.
inline constexpr uint32_t kMaxCorners = 1U << 14;

/// Cuts a polygon into triangles, appended to `out`: concave ones right (ear clipping in the plane
/// along its longest axis of area), with the orientation of the polygon. Fewer than three corners:
/// nothing. The corners are in range of `positions`.
void triangulate(const std::vector<Vec3>& positions, std::span<const uint32_t> polygon,
                 std::vector<std::array<uint32_t, 3>>& out);

/// Cuts all polygons into triangles, as triangulate() does; their corners stand one after the other
/// and of which there are `sizes`: in parallel, and in the same order whatever the number of
/// threads.
void triangulate_all(const std::vector<Vec3>& positions, std::span<const uint32_t> corners,
                     std::span<const uint32_t> sizes, std::vector<std::array<uint32_t, 3>>& out);

/// Removes vertices that no triangle uses, keeping the order of the others.
void drop_unused_vertices(TriangleMesh& mesh);

/// What every reader does last: checks that indices are in range, drops unused vertices, makes
/// normals unit vectors (those that are not finite, or 0, become 0: there facets are flat), reads
/// off the bounds. Errors: an index out of range (with its face), a position or UV that is not
/// finite, no triangles.
Status complete_mesh(TriangleMesh& mesh);

/// The complaint about a file that is of no format known here.
inline constexpr const char* kNoMesh =
    "it is no mesh file that is known; expected OBJ or PLY, which Blender makes of others";

/// Readers of one format each, from the bytes of a whole file. Errors do not name the file.
Result<std::shared_ptr<TriangleMesh>> read_ply(std::span<const char> bytes);
Result<std::shared_ptr<TriangleMesh>> read_obj(std::span<const char> bytes);

/// Reads an OBJ file, cut into its materials.
Result<MeshParts> read_obj_parts(std::span<const char> bytes);

}  // namespace hyades::core
