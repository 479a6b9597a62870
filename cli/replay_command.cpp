#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/load_job.h"
#include "cli/number_range.h"
#include "cli/scene_options.h"
#include "cli/whole_numbers.h"
#include "core/job/layers.h"
#include "core/render/frame_renderer.h"
#include "core/scene/build_scene.h"

namespace hyades::cli {

/// `hyades replay job.yaml --frame F --pixel X,Y --sample N`: traces one sample and tells its path
/// in words.
int replay_command(int argc, char** argv) {
  CLI::App app(
      "Traces one sample of one pixel and tells its path in words: what it met, how it scattered, "
      "where light came in.",
      "hyades replay");
  std::string path;
  SceneOptions scene_options;
  int32_t frame = 0;
  std::vector<int> pixel;
  uint32_t sample = 0;
  app.add_option("job", path, job_words())->required();
  declare_class_option(app, scene_options);
  declare_scene_options(app, scene_options);
  auto* frame_option = app.add_option("--frame", frame, "frame number (default: the job's first)");
  add_whole_numbers(app, "--pixel", pixel, "X,Y", "in full-frame pixels, 0,0 is the top left")
      ->required();
  app.add_option("--sample", sample, "index of the sample within the pixel")->default_val(0);
  app.footer(
      "examples:\n  hyades replay jobs/cornell/job.yaml --pixel 120,80 --sample 3\n"
      "exit status: 0 told, 2 the job or the arguments are wrong");
  if (const auto status = parse_command_line(app, argc, argv, kBadInput)) return *status;
  auto loaded = load_job(path, scene_options);
  if (!loaded) return kBadInput;
  const core::Job& job = loaded->job;
  if (frame_option->empty()) frame = job.frames.first;
  const core::PixelRect whole{0, 0, job.film.width, job.film.height};
  if (!whole.contains(pixel[0], pixel[1])) {
    std::fprintf(stderr, "--pixel %d,%d: expected a pixel of the frame, 0,0 to %d,%d\n", pixel[0],
                 pixel[1], whole.x1 - 1, whole.y1 - 1);
    return kBadInput;
  }
  if (!is_in_range(job, frame)) return kBadInput;
  core::SceneCache cache(*loaded->assets);
  auto scene = core::build_scene(job, frame, cache);
  if (!scene) {
    print_error(scene.error());
    return 1;
  }
  const core::FrameRenderer renderer(*scene, job, frame, core::needed_layers(job));
  core::PathLog log;
  const core::PixelSample result = renderer.replay({pixel[0], pixel[1]}, sample, log);
  std::printf("%s, frame %d, pixel %d,%d, sample %u\n", job.name.c_str(), frame, pixel[0], pixel[1],
              sample);
  for (const std::string& line : log.lines) std::printf("%s\n", line.c_str());
  std::printf("radiance %.9g %.9g %.9g, alpha %g, depth %g\n",
              static_cast<double>(result.radiance.x), static_cast<double>(result.radiance.y),
              static_cast<double>(result.radiance.z), static_cast<double>(result.alpha),
              static_cast<double>(result.depth));
  if (const auto why = core::why_not_counted(result)) {
    std::printf("this sample is not counted: %s\n", why->c_str());
  }
  return 0;
}

}  // namespace hyades::cli
