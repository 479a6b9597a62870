#include "cli/render_options.h"

#include <cstdio>

#include <CLI/CLI.hpp>

#include "cli/address_option.h"
#include "cli/command_line.h"
#include "cli/frame_range.h"
#include "cli/preview.h"

namespace hyades::cli {

std::optional<int> parse_render_options(int argc, char** argv, RenderOptions& options) {
  CLI::App app("Renders a job, or a scene or mesh of another tool, on this machine.",
               "hyades render");
  app.add_option("job", options.path,
                 "the job (.yaml), or a scene or mesh (.glb, .gltf, .pbrt, .obj, .ply)")
      ->required();
  declare_scene_options(app, options.scene);
  app.add_option("--frames", options.frames,
                 "frames to render: 7, 1-10 or 1-10x2 (default: all; at most a million)")
      ->check(no_frames_error);
  app.add_option("--samples", options.samples, "samples per pixel (default: the job's)")
      ->check(CLI::Range(1U, 1U << 24U));
  app.add_option("--crop", options.crop, "X0,Y0,X1,Y1: render only these pixels")
      ->delimiter(',')
      ->expected(4);
  app.add_flag("--preview{320}", options.preview,
               "render a small denoised picture of the first frame (or --frames) with 32 samples, "
               "NAME.preview.png; --preview=N makes it N pixels wide")
      ->check(CLI::Range(16, 8192));
  app.add_option("--threads", options.threads, "rendering threads")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--film-memory", options.film_memory,
                 "most memory that films may take, such as 8G; jobs of larger ones are refused "
                 "(default: half of what is here)")
      ->transform(CLI::AsSizeValue(false));
  app.add_option(
         "--texture-memory", options.texture_memory,
         "most memory for the pixels of textures, such as 2G; others lie in files of TMPDIR "
         "(default: a quarter of what is here)")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--display", options.display,
                 "HOST:PORT of the viewer tev: shows the picture there while it is rendered, with "
                 "all its layers (tev listens on 127.0.0.1:14158)")
      ->check(address_error);
  app.add_option("--output", options.folder, "folder for what is written")->capture_default_str();
  app.add_flag("--film", options.film,
               "also write each frame's film (NAME.film.exr), for 'hyades merge', as keep_films in "
               "the job does");
  app.add_flag("--resume", options.resume, "continue a run that was interrupted, to the same bits");
  app.add_flag("--quiet", options.quiet, "show no progress");
  app.footer(
      "examples:\n"
      "  hyades render jobs/quickstart/job.yaml\n"
      "  hyades render jobs/perlin-sphere/job.yaml --frames 1-24 --output out --resume\n"
      "  hyades render jobs/atlas/job.yaml --preview\n"
      "  hyades render jobs/cornell/job.yaml --display 127.0.0.1:14158\n"
      "  hyades render robot.glb --samples 64\n"
      "  hyades render bottles.obj --media media.json\n"
      "Ctrl-C stops; --resume continues, also after a crash.\n"
      "exit status: 0 done, 1 something failed, 2 the job or the arguments are wrong, 130 "
      "interrupted");
  return parse_command_line(app, argc, argv, kBadInput);
}

std::optional<LoadedJob> load_for_render(const RenderOptions& options) {
  auto loaded = load_job(options.path, options.scene);
  if (!loaded) return std::nullopt;
  core::Job& job = loaded->job;
  if (options.preview > 0) make_preview(job, options.preview);
  if (options.samples > 0) job.sampling.samples = options.samples;
  if (!options.crop.empty()) {
    const core::PixelRect crop{options.crop[0], options.crop[1], options.crop[2], options.crop[3]};
    const core::PixelRect whole = core::render_window(job.film);
    if (crop.empty() || !whole.contains(crop)) {
      std::fprintf(stderr,
                   "--crop: expected X0,Y0,X1,Y1 within what the job renders, %d,%d,%d,%d\n",
                   whole.x0, whole.y0, whole.x1, whole.y1);
      return std::nullopt;
    }
  }
  return loaded;
}

core::PixelRect window_of(const RenderOptions& options, const core::Job& job) {
  const core::PixelRect whole = core::render_window(job.film);
  if (options.crop.empty()) return whole;
  return intersection(whole, {options.crop[0], options.crop[1], options.crop[2], options.crop[3]});
}

}  // namespace hyades::cli
