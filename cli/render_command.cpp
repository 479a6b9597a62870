#include <cstdio>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/load_job.h"
#include "core/base/parallel.h"
#include "core/image/write_image.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"

namespace hyades::cli {

int render_command(int argc, char** argv) {
  CLI::App app("Renders a job on this machine.", "hyades render");
  std::string path;
  std::string frames_text;
  std::string folder = ".";
  int threads = core::hardware_threads();
  uint32_t samples = 0;
  app.add_option("job", path, "the job (.yaml) or mesh (.obj, .ply)")->required();
  app.add_option("--frames", frames_text, "frames to render: 7, 1-10 or 1-10x2 (default: all)");
  app.add_option("--samples", samples, "samples per pixel (default: the job's)");
  app.add_option("--threads", threads, "rendering threads")->check(CLI::Range(1, 1024))->capture_default_str();
  app.add_option("--output", folder, "folder for what is written")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : kBadInput;
  }
  auto loaded = load_job(path);
  if (!loaded) return kBadInput;
  core::Job& job = loaded->job;
  if (samples > 0) job.sampling.samples = samples;
  const auto frames = select_frames(job, frames_text);
  if (!frames) return kBadInput;
  core::SceneCache cache(*loaded->assets);
  for (const int32_t frame : *frames) {
    auto scene = core::build_scene(job, frame, cache);
    if (!scene) {
      std::fprintf(stderr, "%s: %s\n", path.c_str(), scene.error().message.c_str());
      return 1;
    }
    const core::FrameRenderer renderer(*scene, job, frame, {});
    core::RenderFrameOptions options;
    options.threads = threads;
    const auto rendered = core::render_frame(renderer, core::render_window(job.film), job.sampling.samples, frame, options);
    const auto written = core::write_exr(folder + "/" + job.name + ".exr", rendered.film.normalised());
    if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  }
  return 0;
}

}  // namespace hyades::cli
