#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/job/job.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// The files that a scene of a job is made of, as the cache is asked for them; each once, in the
/// order in which building asks.
struct SceneFiles {
  std::vector<std::pair<std::string, MeshNormals>> meshes;
  std::vector<std::pair<std::string, ColorSpace>> images;
  std::string sky;  ///< empty: none
};

/// Those of what the scene shows: groups, materials and textures that nothing uses do not count.
SceneFiles files_of_scene(const Job& job);

/// Loads them into `cache`, several at once. What cannot be loaded is left to who builds the scene:
/// it meets the errors in the order of the document, whatever came first here.
void load_files(const Job& job, SceneCache& cache);

}  // namespace hyades::core
