#pragma once

#include "core/geometry/mesh.h"
#include "import/pbrt/scene.h"

namespace hyades::core::pbrt {

/// Whether a sphere, disk or cylinder is only a part of one, or looks inwards, so that the job
/// language has no shape for it.
bool needs_tessellation(const ShapeEntity& shape);

/// Such a part as triangles: 128 around a full turn, with smooth normals and pbrt's uvs.
Result<TriangleMesh> tessellated_mesh(const ShapeEntity& shape, Report& report);

}  // namespace hyades::core::pbrt
