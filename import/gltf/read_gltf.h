#pragma once

#include <memory>
#include <string>

#include "import/scene_source.h"

namespace hyades::core {

/// Reads a glTF 2.0 file (.gltf or .glb), and buffers beside it, through `files`. docs/import.md
/// says what becomes of what.
Result<std::shared_ptr<const SceneSource>> read_gltf(AssetResolver& files,
                                                     const std::string& reference);

}  // namespace hyades::core
