#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Scenes of other tools in a job. For a scene file `robot.glb` there is a folder `robot.glb.files`
/// that no disk holds: whoever imports scenes (import/) makes its files when they are opened,
/// and a farm stores them as any others. In it lies the scene as a document of the job language.
namespace hyades::core {

/// Parameters of a script, as whoever runs it gives them: name and value.
using ScriptSettings = std::vector<std::pair<std::string, std::string>>;

/// Which scene is meant, and how it is to be told.
struct SceneDocument {
  std::string scene;      ///< the scene file, as a reference
  std::string prefix;     ///< stands before all names that it gives, and a '.'; empty: nothing
  float fps = 24.0F;      ///< of the job; of a script 0 where the job leaves that to it
  std::string animation;  ///< the one that is meant, of several; empty: the first; "none": still
  bool loop = false;      ///< whether it begins again where it ends
  std::string frames{};   ///< of a script: the range of the job ("1-48"); empty: the script's own
  ScriptSettings set{};   ///< of a script
};

/// Added to a scene file's name: the folder of what is made of it.
inline constexpr std::string_view kMadeFolder = ".files";

/// Whether a file's name is that of a scene, mesh or script that importers read.
bool is_scene_file(std::string_view name);

/// The ends of their names: ".glb, .gltf, .pbrt, .obj, .ply, .lua".
std::string scene_file_ends();

/// What can be done with a scene file of other tools that importers do not read, such as a .fbx:
/// ": Blender opens it, and writes .glb"; empty of any other name.
std::string hint_for_scene_file(std::string_view name);

/// Whether a file's name is that of a script which makes a job: .lua.
bool is_script_file(std::string_view name);

/// Whether a script may have a parameter of this name: 1 to 64 letters, digits and '_', no digit
/// first.
bool is_setting_name(std::string_view name);

/// Where the document of a scene lies: "robot.glb.files/scene,prefix=robot,fps=24.yaml". That of a
/// script lies beside it, for it names files as the script does: "city.lua,fps=24,set.seed=3.yaml".
std::string reference_of(const SceneDocument& document);

/// The document that `reference` names; nothing where it names something else.
std::optional<SceneDocument> document_of(std::string_view reference);

}  // namespace hyades::core
