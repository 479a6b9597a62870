#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "import/gltf/model.h"

namespace hyades::core {

/// A primitive that KHR_draco_mesh_compression holds, decoded.
struct DracoMesh {
  struct Attribute {
    size_t components = 0;
    std::vector<float> values;  ///< per vertex
  };
  std::map<std::string, Attribute> attributes;  ///< by semantic
  std::vector<uint32_t> indices;                ///< three per triangle
};

/// Decodes the triangles and attributes of a primitive with `draco`. Errors name it.
Result<DracoMesh> decode_draco(const GltfModel& model, const GltfPrimitive& primitive);

}  // namespace hyades::core
