#include "cli/scene_options.h"

#include <cstdio>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/base/printable.h"

namespace hyades::cli {

namespace {

constexpr size_t kMostNotes = 40;

}  // namespace

void declare_scene_options(CLI::App& app, SceneOptions& options) {
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
}

core::JobFileOptions job_file_options(const SceneOptions& options) {
  return {
      options.media,
      options.missing_textures ? core::MissingTextures::magenta : core::MissingTextures::refused,
      options.animation, options.loop, options.follow_links};
}

void print_notes(const core::JobFiles& files) {
  const std::vector<std::string> notes = files.notes();
  for (size_t i = 0; i < notes.size() && i < kMostNotes; ++i) {
    std::fprintf(stderr, "%s\n", core::printable(notes[i]).c_str());
  }
  if (notes.size() > kMostNotes) {
    std::fprintf(stderr, "and %zu more such notes\n", notes.size() - kMostNotes);
  }
}

}  // namespace hyades::cli
