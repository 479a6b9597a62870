#pragma once

#include <cstdint>

#include "core/geometry/mesh.h"
#include "import/pbrt/scene.h"

namespace hyades::core::pbrt {

/// Whether shapes of this type become meshes that are made here.
bool is_made_mesh(const ShapeEntity& shape);

/// The triangles of a shape in its own space. Errors name the place: indices out of range, lists
/// that do not fit together, absurd counts. `count_only` stops before memory is taken.
Result<TriangleMesh> mesh_of(const ShapeEntity& shape, Report& report);

/// Everything wrong with it that mesh_of() would find, and nothing made. The number of its
/// triangles or, where there are more, vertices; of bent and flat patches as if all were bent.
Result<uint64_t> check_mesh(const ShapeEntity& shape, Report& report);

/// The triangles that "loopsubdiv" begins with, without normals and uvs.
Result<TriangleMesh> control_mesh(const ShapeEntity& shape, Report& report);

/// Turns the surface inside out.
void reverse(TriangleMesh& mesh);

}  // namespace hyades::core::pbrt
