#pragma once

#include "core/geometry/mesh.h"
#include "import/pbrt/scene.h"

namespace hyades::core::pbrt {

/// A "curve" as triangles: of type cylinder a tube of six sides, of type ribbon a band across its
/// normals, of type flat, which would turn to whoever looks, a tube, too.
Result<TriangleMesh> curve_mesh(const ShapeEntity& shape, Report& report);

/// Whether it can be made.
Status check_curve(const ShapeEntity& shape, Report& report);

}  // namespace hyades::core::pbrt
