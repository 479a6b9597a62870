#pragma once

#include <cstdint>

#include "core/geometry/curve_set.h"
#include "core/geometry/mesh.h"
#include "import/pbrt/scene.h"

/// Shapes that the job language has not, as triangles; and curves as strands.
namespace hyades::core::pbrt {

/// Whether a shape is a "curve" that the job language has as strands: of type cylinder, or flat,
/// which would turn to whoever looks. Ribbons, and what shines, are triangles.
bool is_strand(const ShapeEntity& shape);

/// Adds such a curve, in its own space, to `strands`: points of Bezier's.
Status append_strand(const ShapeEntity& shape, Report& report, StrandList& strands);

/// A "curve" as triangles: of type ribbon a band across its normals, else a tube of six sides.
Result<TriangleMesh> curve_mesh(const ShapeEntity& shape, Report& report);

/// Whether it can be made; the number of its triangles, or of a strand's pieces.
Result<uint64_t> check_curve(const ShapeEntity& shape, Report& report);

/// A "loopsubdiv": its triangles subdivided `levels` times (Loop 1987), brought to the limit
/// surface, with its normals. Errors: what is wrong with the lists, a mesh whose edges have more
/// than two triangles, and more than 2^26 triangles.
Result<TriangleMesh> subdivided_mesh(const ShapeEntity& shape, Report& report);

/// Whether subdivided_mesh() can make it, told before memory is taken; the number of its triangles.
Result<uint64_t> check_subdivision(const ShapeEntity& shape, Report& report);

/// Whether a sphere, disk or cylinder is only a part of one, or looks inwards, so that the job
/// language has no shape for it.
bool needs_tessellation(const ShapeEntity& shape);

/// How many triangles tessellated_mesh() makes of it at most.
uint64_t tessellated_triangles(const ShapeEntity& shape);

/// Such a part as triangles: 128 around a full turn, with smooth normals and pbrt's uvs.
Result<TriangleMesh> tessellated_mesh(const ShapeEntity& shape, Report& report);

}  // namespace hyades::core::pbrt
