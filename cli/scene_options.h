#pragma once

#include <string>

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
};

/// Options --media, --animation, --loop, --missing-textures and --follow-links.
void declare_scene_options(CLI::App& app, SceneOptions& options);

core::JobFileOptions job_file_options(const SceneOptions& options);

/// What was left out of scenes and which pictures are missing, on standard error.
void print_notes(const core::JobFiles& files);

}  // namespace hyades::cli
