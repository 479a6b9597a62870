#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Scenes of other tools in a job. For a scene file `robot.glb` there is a folder `robot.glb.files`
/// that no disk holds: whoever imports scenes (import/) makes its files when they are opened,
/// and a farm stores them as any others. In it lies the scene as a document of the job language.
namespace hyades::core {

/// Which scene is meant, and how it is to be told.
struct SceneDocument {
  std::string scene;      ///< the scene file, as a reference
  std::string prefix;     ///< stands before all names that it gives, and a '.'; empty: nothing
  float fps = 24.0F;      ///< of the job
  std::string animation;  ///< the one that is meant, of several; empty: the first; "none": still
  bool loop = false;      ///< whether it begins again where it ends
};

/// Added to a scene file's name: the folder of what is made of it.
inline constexpr std::string_view kMadeFolder = ".files";

/// Whether a file's name is that of a scene (or mesh) that importers read: .gltf, .glb, .pbrt, .obj
/// or .ply.
bool is_scene_file(std::string_view name);

/// Where the document of a scene lies: "robot.glb.files/scene,prefix=robot,fps=24.yaml".
std::string reference_of(const SceneDocument& document);

/// The document that `reference` names; nothing where it names something else.
std::optional<SceneDocument> document_of(std::string_view reference);

}  // namespace hyades::core
