#pragma once

#include <memory>
#include <string>

#include "import/scene_source.h"

namespace hyades::core {

/// Reads an OBJ file with the files of materials that it names, or a PLY file, as a scene: one
/// object per material (usemtl), which refers to the mesh's own file. Materials that are nowhere
/// said are clay; a file of them that is missing is a note.
Result<std::shared_ptr<const SceneSource>> read_obj_scene(AssetResolver& files,
                                                          const std::string& reference);

}  // namespace hyades::core
