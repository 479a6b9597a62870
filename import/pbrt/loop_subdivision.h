#pragma once

#include "core/geometry/mesh.h"
#include "import/pbrt/scene.h"

namespace hyades::core::pbrt {

/// A "loopsubdiv": its triangles subdivided `levels` times (Loop 1987), brought to the limit
/// surface, with its normals. Errors: what is wrong with the lists, a mesh whose edges have more
/// than two triangles, and more than 2^26 triangles.
Result<TriangleMesh> subdivided_mesh(const ShapeEntity& shape, Report& report);

/// Whether it can be made, told before memory is taken.
Status check_subdivision(const ShapeEntity& shape, Report& report);

}  // namespace hyades::core::pbrt
