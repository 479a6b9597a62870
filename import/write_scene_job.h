#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "import/importing_resolver.h"

namespace hyades::core {

/// A scene that is to be written as a job which a person can read and edit.
struct WriteSceneJob {
  std::string scene;          ///< path of the scene file
  std::string job;            ///< path of the job to be written
  std::string media;          ///< path of a file of media for its materials; empty: none
  std::string animation;      ///< SceneRequest::animation
  bool loop = false;          ///< SceneRequest::loop
  float fps = 24.0F;          ///< of a script: its own
  ScriptSettings set{};       ///< SceneRequest::set
  bool overwrite = false;     ///< replace what is there already
  bool follow_links = false;  ///< of the scene's folder, wherever they lead
  MissingTextures missing = MissingTextures::refused;
};

/// What was written.
struct WrittenSceneJob {
  std::vector<std::string> files;  ///< paths: the job last
  std::vector<std::string> notes;  ///< of the importer
};

/// Writes the job of a scene (scene_job()) to `job`, and beside it, in the folder "<job>_files",
/// what it is made of that is no file yet: meshes as binary PLY (those of OBJ files too), pictures
/// as they are. Pictures that are files stay where they are. Each file is complete or absent; the
/// job comes last. Errors: the scene's, a file that is there already, a disk that takes no more.
Result<WrittenSceneJob> write_scene_job(const WriteSceneJob& request);

}  // namespace hyades::core
