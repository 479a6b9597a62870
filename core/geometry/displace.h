#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "core/base/result.h"
#include "core/geometry/mesh.h"

namespace hyades::core {

/// How far the surface moves at a place of it: (uv, position) -> length, both in object space. uv
/// is 0 for meshes without. Called by several threads.
using HeightField = std::function<float(const Vec2&, const Vec3&)>;

/// The normals of a displaced mesh.
enum class DisplacedNormals {
  creased,  ///< smooth, but sharp where the mesh has several normals at one place
  smooth,   ///< smooth everywhere
  flat,     ///< those of its triangles
};

struct Displacement {
  float max_edge = 0.0F;  ///< of the triangles before they are moved, in object space; above 0
  size_t budget = 0;      ///< most triangles
  DisplacedNormals normals = DisplacedNormals::creased;
};

/// `base` in small triangles (see tessellate), moved by `height` along its smooth normals: at its
/// vertices the angle-weighted mean of the triangles around the place, interpolated between.
/// Vertices at one position move together, by the mean of their heights, so that seams of uv and
/// creases do not open. Tangents are left out. The same bits for any number of threads. Errors:
/// over the budget; a height that is not finite.
Result<std::shared_ptr<TriangleMesh>> displace(const TriangleMesh& base, const Displacement& how,
                                               const HeightField& height);

}  // namespace hyades::core
