#pragma once

#include "import/pbrt/scene.h"
#include "import/pbrt/scene_files.h"

namespace hyades::core::pbrt {

/// Reads a scene's main file and all that it includes. Errors name file, line and column.
Result<ParsedScene> read_scene_text(const SceneFiles& files);

}  // namespace hyades::core::pbrt
