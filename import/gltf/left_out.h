#pragma once

#include <string>
#include <vector>

#include "import/gltf/model.h"

namespace hyades::core {

/// What the vertices of a file's meshes and morph targets have and jobs do not, a line for each
/// kind of it: "COLOR_1 of meshes[0].primitives[0] and 3 more is left out".
std::vector<std::string> left_out_attributes(const GltfModel& model);

}  // namespace hyades::core
