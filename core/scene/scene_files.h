#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/job/job.h"
#include "core/scene/scene_cache.h"

namespace hyades::core {

/// What a light makes of its picture; a map of directions is chosen from by its SkyDensity.
enum class LightMap { luminance, excess, gobo };

/// A file as the cache is asked for it, and who asks first.
template <class How>
struct SceneFile {
  std::string file;
  How how;                ///< MeshUse, ImageUse or LightMap
  std::string user;       ///< "object 'vase'", for messages
  SourceLocation where;   ///< of that user
  bool of_frame = false;  ///< a mesh that only some frames look at (SceneCache::frame_mesh)
};

/// The files that a scene of a job is made of; each once, in the order in which building asks.
struct SceneFiles {
  std::vector<SceneFile<MeshUse>> meshes;
  std::vector<SceneFile<ImageUse>> images;
  std::vector<SceneFile<LightMap>> light_maps;
};

/// The files of what the scene shows: groups, materials and textures that nothing uses do not
/// count. Of meshes with a file for each frame those that `frame` looks at; without it none.
SceneFiles files_of_scene(const Job& job, std::optional<int32_t> frame = std::nullopt);

/// The files of everything that the job holds, used or not, at all its frames; also of a job with
/// mistakes in it.
SceneFiles files_of_job(const Job& job);

/// The files of `all` that are not among `some`.
SceneFiles without(SceneFiles all, const SceneFiles& some);

/// Meshes that are loaded already: whoever holds them finds them in the cache.
using HeldMeshes = std::vector<std::shared_ptr<const TriangleMesh>>;

/// Loads `files` into `cache`, several at once, and complains about each that cannot be loaded.
/// `held` gets the meshes of frames; null: they are looked at and let go.
Status load_files(const SceneFiles& files, SceneCache& cache, Diagnostics& diagnostics,
                  HeldMeshes* held = nullptr);

/// Loads the files of the job's scene at `frame` (without it those that all frames share) into
/// `cache`, several at once. The result keeps those of that frame. The error lists all that
/// cannot be loaded, a line each
/// ("job.yaml:7:3: object 'vase': vase.obj: line 4: ..."), in the order of the document, whatever
/// failed first.
Result<HeldMeshes> load_files(const Job& job, std::optional<int32_t> frame, SceneCache& cache);

}  // namespace hyades::core
