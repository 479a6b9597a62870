#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "import/gltf/json_value.h"

namespace hyades::core {

/// A .gltf or .glb file taken apart.
struct GltfContainer {
  std::shared_ptr<const nlohmann::json> json;
  Bytes binary;  ///< the BIN chunk of a .glb
  bool has_binary = false;
};

/// Most bytes of JSON, and how deep lists and objects may lie within each other.
inline constexpr size_t kMaxGltfJson = size_t{256} << 20;
inline constexpr int kMaxGltfDepth = 64;

/// Splits a .glb into its chunks (glTF 2.0, section 4.4) and parses the JSON. Errors do not name
/// the file.
Result<GltfContainer> open_container(const Bytes& file);

/// The bytes of the buffers, each at least as long as it says: the BIN chunk, data: URIs, files
/// beside `reference`. Buffers without bytes, for views that are compressed elsewhere, are empty.
Result<std::vector<Bytes>> read_buffers(const GltfContainer& container, const JsonValue& root,
                                        AssetResolver& files, const std::string& reference);

}  // namespace hyades::core
