#pragma once

#include <cstddef>
#include <string>

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// Whether media of this type vary from place to place: "uniformgrid", "rgbgrid", "cloud",
/// "nanovdb".
bool is_grid_medium(const std::string& type);

/// The medium of number `index` of the scene in the job language, in a body whose space is brought
/// to that of the scene by `body`; its grids are the file "media/INDEX.vdb", or a file of the
/// scene. Null, and an error of the report, where it cannot be made.
YamlPtr grid_medium_node(Context& context, size_t index, const Mat4d& body);

/// The bytes of "media/INDEX.vdb".
Result<Bytes> make_medium_file(const LoadedScene& scene, const std::string& name);

}  // namespace hyades::core::pbrt
