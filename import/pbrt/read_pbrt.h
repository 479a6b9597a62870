#pragma once

#include <memory>
#include <string>

#include "core/base/assets.h"
#include "import/scene_source.h"

namespace hyades::core {

/// Reads a scene of pbrt-v4 (.pbrt): `reference` through `files`, and the files that it includes.
/// docs/import.md says what becomes of what. Errors name the file, the line and the column.
Result<std::shared_ptr<const SceneSource>> read_pbrt(AssetResolver& files,
                                                     const std::string& reference);

}  // namespace hyades::core
