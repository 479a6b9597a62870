#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/base/bounds.h"
#include "core/base/result.h"
#include "core/job/scene_document.h"
#include "core/job/yaml_tree.h"

/// Scenes of other tools as parts of a job. An importer reads a scene file once and says it in the
/// language of jobs; meshes and pictures that lie within the file become files of their own, made
/// when somebody opens them.
namespace hyades::core {

/// What part of a scene is asked for, and what the job around it is like.
struct SceneRequest {
  /// Of all names that the scene gives, a '.' follows: "robot" makes "robot.Skin". Empty: none.
  std::string prefix;
  /// The job's frames per second: frame f shows the scene at (f - 1) / fps. 0: a script's own.
  float fps = 24.0F;
  std::string
      animation;      ///< of several in the file, the one meant; empty: the first; "none": still
  bool loop = false;  ///< whether the animation begins again where it ends
  /// Stands before the names of files that are made: "meshes/body.ply" is `made` + that.
  std::string made;
  /// Stands before the names of files that lie beside the scene's: "../".
  std::string beside;
  std::string frames{};  ///< of a script: the range of the job ("1-48"); empty: the script's own
  ScriptSettings set{};  ///< of a script: its parameters
};

/// A scene in the language of jobs.
struct SceneSections {
  /// A map of a job's sections, docs/job.md: textures, materials, media, groups, objects, lights,
  /// environment, camera, frames, film, sampling, integrator, atmosphere; those that it has. Of a
  /// script: whatever a job may have.
  YamlPtr sections;
  /// Of all that is seen, at the first frame, in the space of the job; empty: not known. For who
  /// looks for a camera's place.
  Bounds bounds;
  /// What the scene says and has no counterpart here, one line each, the place in the file first.
  std::vector<std::string> notes;
  /// The files beside the scene's that the sections name, from the scene's folder on.
  std::vector<std::string> files{};
  /// Whether all that emits is a lamp, however dim. In other formats labels and screens emit, in
  /// scenes that are looked at by the light of whoever shows them.
  bool emitters_are_lamps = false;
};

/// One scene file that has been read. Immutable and thread-safe.
class SceneSource {
 public:
  virtual ~SceneSource() = default;

  /// The scene; errors name the file and the place in it.
  virtual Result<SceneSections> sections(const SceneRequest& request) const = 0;

  /// The bytes of file `name` ("meshes/body.ply"), which sections() names with `made` before it;
  /// those of an animated mesh have the number of the frame in their names
  /// ("meshes/24/Walk/body.0012.ply" where the job says "body.####.ply").
  virtual Result<Bytes> made_file(const std::string& name) const = 0;
};

/// Reads a scene file: `reference` through `files`, and what it names in its turn. Told apart by
/// its name: is_scene_file(). Errors name the file and the place. `files` must
/// outlive what is returned.
Result<std::shared_ptr<const SceneSource>> read_scene(AssetResolver& files,
                                                      const std::string& reference);

}  // namespace hyades::core
