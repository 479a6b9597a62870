#pragma once

#include "core/base/bytes.h"
#include "core/import/gltf/geometry.h"

namespace hyades::core {

/// A binary PLY file of a primitive's triangles; v of uv turned so that it grows upwards, as jobs
/// have it.
Bytes write_ply(const GltfGeometry& geometry);

}  // namespace hyades::core
