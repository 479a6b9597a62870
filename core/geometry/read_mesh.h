#pragma once

#include <memory>
#include <string>

#include "core/base/assets.h"
#include "core/base/result.h"
#include "core/geometry/mesh.h"

namespace hyades::core {

/// Reads an OBJ or PLY (ASCII, binary little- or big-endian) mesh, told apart by content. Polygons
/// are triangulated; vertices without a face are dropped; OBJ vertices with several normals or UVs
/// are split. Errors name the file and, for text, the line: truncated data, indices out of range,
/// non-finite positions, absurd counts (checked against the file's size before memory is taken).
Result<std::shared_ptr<TriangleMesh>> read_mesh(AssetResolver& assets,
                                                const std::string& reference);

}  // namespace hyades::core
