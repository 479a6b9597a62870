#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/render_class.h"
#include "import/job_files.h"

namespace CLI {
class App;
}

namespace hyades::cli {

/// What commands that read jobs are told of scenes of other tools.
struct SceneOptions {
  std::string media;              ///< file of media for a scene's materials; empty: none
  std::string animation;          ///< of a scene with several, the one that is meant
  bool loop = false;              ///< whether it begins again where it ends
  bool missing_textures = false;  ///< pictures that are not there are magenta, not errors
  bool follow_links = false;      ///< out of scenes' folders too
  std::vector<std::string> set;   ///< of a script: "name=value"
  std::optional<core::RenderClass> render_class;  ///< instead of the job's: declare_class_option()
  std::string frames;  ///< of a .blend: those that are wanted; empty: all. No option here
};

/// What commands take as their job, for their help.
std::string job_words();

/// Options --media, --animation, --loop, --missing-textures, --follow-links and --set.
void declare_scene_options(CLI::App& app, SceneOptions& options);

/// Option --class.
void declare_class_option(CLI::App& app, SceneOptions& options);

/// Option --set of scripts, into `set`.
void declare_set_option(CLI::App& app, std::vector<std::string>& set);

/// "seed=3" as name and value, each; those must have been checked by declare_set_option().
core::ScriptSettings script_settings(const std::vector<std::string>& set);

core::JobFileOptions job_file_options(const SceneOptions& options);

/// Lines about what was left out of scenes and which pictures are missing, the first 40 of them, on
/// standard error.
void print_notes(const std::vector<std::string>& notes);

}  // namespace hyades::cli
