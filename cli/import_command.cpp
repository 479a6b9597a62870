#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/blend_job.h"
#include "cli/command_line.h"
#include "cli/load_job.h"
#include "cli/number_range.h"
#include "cli/scene_options.h"
#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/job/output_path.h"
#include "core/job/scene_document.h"
#include "import/write_scene_job.h"

namespace hyades::cli {

/// `hyades import robot.glb -o robot.yaml`: a scene of another tool as a job to be read and edited.
int import_command(int argc, char** argv) {
  CLI::App app(
      "Writes a scene of another tool as a job, with its meshes (binary PLY) and pictures in the "
      "folder JOB_files beside it. 'hyades render' takes scenes without this too.",
      "hyades import");
  core::WriteSceneJob request;
  app.add_option("scene", request.scene,
                 "the scene, mesh or script (" + core::scene_file_ends() + ")")
      ->required();
  app.add_option("-o,--output", request.job, "the job to be written (default: SCENE.yaml, here)");
  app.add_option("--media", request.media,
                 "fill the materials that have the names of this file's media");
  app.add_option("--animation", request.animation,
                 "of several animations in the file, the one that is meant (default: the first; "
                 "none: the scene stands still)");
  app.add_flag("--loop", request.loop, "the animation begins again where it ends");
  app.add_option("--fps", request.fps, "frames per second of the job")
      ->check(in_range(0.001F, 1e6F))
      ->capture_default_str();
  app.add_flag("--overwrite", request.overwrite, "replace files that are there already");
  bool quiet = false;
  app.add_flag("-q,--quiet", quiet, "say nothing where all goes well");
  std::vector<std::string> set;
  declare_set_option(app, set);
  bool missing_textures = false;
  app.add_flag("--missing-textures", missing_textures,
               "let magenta stand in for pictures that are not there and that have to be read");
  app.add_flag("--follow-links", request.follow_links,
               "follow links that lead out of the scene's folder: only of scenes that you trust");
  app.footer(
      "examples:\n  hyades import robot.glb -o robot.yaml && hyades render robot.yaml\n"
      "exit status: 0 written, 2 not");
  if (const auto status = parse_command_line(app, argc, argv, kBadInput)) return *status;
  if (!core::is_scene_file(request.scene)) {
    print_error(
        core::Error{"expected a scene, mesh or script (" + core::scene_file_ends() + ")" +
                    (is_blend_file(request.scene) ? ": Blender writes .glb"
                                                  : core::hint_for_scene_file(request.scene))}
            .in(request.scene));
    return kBadInput;
  }
  if (request.job.empty()) {
    request.job = std::filesystem::path(request.scene).stem().string() + ".yaml";
  }
  const std::string extension = core::file_extension(request.job);
  if (extension != ".yaml" && extension != ".yml") {
    std::fprintf(stderr, "hyades import: %s: expected NAME.yaml\n",
                 core::printable(request.job).c_str());
    return kBadInput;
  }
  request.set = script_settings(set);
  if (missing_textures) request.missing = core::MissingTextures::magenta;
  const auto written = core::write_scene_job(request);
  if (!written) {
    print_error(written.error());
    return kBadInput;
  }
  for (const std::string& note : written->notes) {
    std::fprintf(stderr, "%s\n", core::printable(note).c_str());
  }
  if (quiet) return 0;
  std::fprintf(stderr, "wrote %s", request.job.c_str());
  if (written->files.size() > 1) {
    std::fprintf(stderr, " and %s beside it",
                 core::counted(written->files.size() - 1, "file").c_str());
  }
  std::fprintf(stderr, "\n");
  return 0;
}

}  // namespace hyades::cli
