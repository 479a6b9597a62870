#pragma once

#include <vector>

#include "core/import/gltf/model.h"

namespace hyades::core {

/// Where EXT_mesh_gpu_instancing places the copies of a node's mesh, in the node's space. Errors:
/// attributes of different lengths, numbers that cannot be read.
Result<std::vector<Mat4>> instance_places(const GltfModel& model, const GltfAttributes& attributes);

}  // namespace hyades::core
