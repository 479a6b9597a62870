#include "cli/scene_options.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/base/printable.h"
#include "core/job/scene_document.h"
#include "core/job/script_include.h"

namespace hyades::cli {

namespace {

constexpr size_t kMostNotes = 40;

/// What is wrong with "seed=3"; empty where nothing is.
std::string wrong_set(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos) {
    return "'" + core::printable(text) + "', expected NAME=VALUE, as in seed=3";
  }
  return core::wrong_setting(text.substr(0, equals), text.substr(equals + 1));
}

}  // namespace

std::string job_words() {
  return "the job (.yaml), or a scene, mesh or script (" + core::scene_file_ends() +
         ", and .blend where Blender is installed)";
}

void declare_set_option(CLI::App& app, std::vector<std::string>& set) {
  app.add_option("--set", set,
                 "of a script (.lua), a parameter: seed=3. May be given several times; one that "
                 "the script does not know is answered with those that it does")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)  // what follows is the job
      ->check(wrong_set);
}

core::ScriptSettings script_settings(const std::vector<std::string>& set) {
  core::ScriptSettings settings;
  for (const std::string& text : set) {
    const size_t equals = text.find('=');
    settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return settings;
}

void declare_scene_options(CLI::App& app, SceneOptions& options) {
  const std::string others = app.option_defaults()->get_group();
  app.option_defaults()->group("Scenes, meshes and scripts");
  app.add_option("--media", options.media,
                 "of a scene or mesh: fill the materials that have the names of this file's media");
  app.add_option("--animation", options.animation,
                 "of a scene with several animations, the one that is meant (default: the first; "
                 "none: it stands still)");
  app.add_flag("--loop", options.loop, "the scene's animation begins again where it ends");
  app.add_flag("--missing-textures", options.missing_textures,
               "let magenta stand in for pictures that are not there");
  app.add_flag("--follow-links", options.follow_links,
               "follow links that lead out of a scene's folder: only of scenes that you trust");
  declare_set_option(app, options.set);
  app.option_defaults()->group(others);
}

void declare_class_option(CLI::App& app, SceneOptions& options) {
  const auto& names = core::kRenderClassNames;
  app.add_option_function<std::string>(
         "--class",
         [&](const std::string& name) {
           const auto at = std::find(names.begin(), names.end(), name) - names.begin();
           options.render_class = static_cast<core::RenderClass>(at);
         },
         "native or portable, instead of the job's render.class: portable gives the same pixels on "
         "every processor")
      ->check(CLI::IsMember(names))
      ->type_name("CLASS");
}

core::JobFileOptions job_file_options(const SceneOptions& options) {
  return {
      options.media,
      options.missing_textures ? core::MissingTextures::magenta : core::MissingTextures::refused,
      options.animation,
      options.loop,
      options.follow_links,
      script_settings(options.set)};
}

void print_notes(const std::vector<std::string>& notes) {
  for (size_t i = 0; i < notes.size() && i < kMostNotes; ++i) {
    std::fprintf(stderr, "%s\n", core::printable(notes[i]).c_str());
  }
  if (notes.size() > kMostNotes) {
    std::fprintf(stderr, "and %zu more such notes\n", notes.size() - kMostNotes);
  }
}

}  // namespace hyades::cli
