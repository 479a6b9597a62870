#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// How many shapes from number `first` on become one mesh: in scenes of many, such as hair, small
/// meshes and curves that follow one another and differ in nothing but their points. At least 1.
size_t mesh_run(const std::vector<ShapeEntity>& shapes, size_t first);

/// "12", or "12-to-40" for the run of 29 shapes that begins with number 12.
std::string mesh_run_name(size_t first, size_t run);

/// The mesh "meshes/NAME.ply", or the strands "meshes/NAME.hair", of a scene: shape-N,
/// shape-N-to-M, object-O-N, object-O-N-to-M.
Result<Bytes> make_mesh_file(const LoadedScene& scene, const std::string& name);

}  // namespace hyades::core::pbrt
