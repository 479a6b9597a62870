#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/bounds.h"
#include "import/gltf/instancing.h"
#include "import/gltf/made_meshes.h"
#include "import/gltf/materials.h"
#include "import/gltf/motion.h"

namespace hyades::core {

/// The meshes of the scene's nodes as a job's objects: one per primitive, with the way from its
/// node to the scene as its transform. Many copies of one are a group and a file of places.
struct GltfObjects {
  YamlMap section;
  YamlMap groups;  ///< what copies by files of places are copies of
  Bounds bounds;   ///< of all that is seen at the first frame
};

/// What an object is made from.
struct GltfStage {
  const GltfModel& model;
  const SceneRequest& request;
  const GltfMeshFiles& files;
  const GltfPlaceFiles& places;
  const GltfClip* clip = nullptr;  ///< null: everything stands still
  size_t animation = 0;            ///< its number
  GltfFrames frames;
  std::vector<std::string>& notes;
};

/// Errors: numbers that cannot be read; more than a job can hold.
Result<GltfObjects> write_objects(const GltfStage& stage, GltfMaterials& materials);

}  // namespace hyades::core
