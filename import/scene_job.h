#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/base/result.h"
#include "import/scene_source.h"

namespace hyades::core {

/// A scene that is to be a job by itself.
struct SceneJobRequest {
  std::string scene;         ///< the scene file, as `files` know it
  std::string media;         ///< a file of media for its materials, as `files` know it; empty: none
  std::string media_in_job;  ///< the same as the job names it
  SceneRequest how;          ///< how names and files are told; no prefix
};

struct SceneJob {
  YamlPtr tree;  ///< a whole job
  std::shared_ptr<const SceneSource> source;
  std::vector<std::string> notes;  ///< of the importer
  std::vector<std::string> files;  ///< SceneSections::files
  std::vector<std::string> added;  ///< what the scene does not say itself: "camera", "objects.key"
};

/// The job that shows a scene: as it says itself, and with what it does not say. Without a camera,
/// a three-quarter view that fits it; without any light, a soft key light and a pale sky; without
/// both, a ground under it. A script's is what it says, for it says a job. With `media`, every
/// object whose material (or, of an only one, whatever its name) has the name of a medium there is
/// filled with it, and has the surface of the medium's index of refraction; media of which none
/// fits are an error that names both sides.
Result<SceneJob> scene_job(AssetResolver& files, const SceneJobRequest& request);

}  // namespace hyades::core
