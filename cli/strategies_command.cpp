#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/film_size_option.h"
#include "cli/load_job.h"
#include "cli/number_range.h"
#include "cli/own_files.h"
#include "cli/scene_options.h"
#include "cli/status_line.h"
#include "cli/written_file.h"
#include "core/base/folder_links.h"
#include "core/base/parallel.h"
#include "core/finish/frame_outputs.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"

namespace hyades::cli {
namespace {

struct StrategiesOptions {
  int32_t frame = 0;
  int events = 4;
  int threads = core::hardware_threads();
  std::string output = ".";
  bool overwrite = false;
  bool quiet = false;
  FilmSizeOption size;
};

/// Strategies of up to `events` scattering events, each weighted and not.
int pictures_of(int events) { return events * (events + 5); }

core::Status may_write(const StrategiesOptions& options, const std::string& name,
                       const std::string& job) {
  const std::string path = options.output + "/" + name;
  const std::vector<std::string> paths = {path + ".exr", path + ".png"};
  for (const std::string& each : paths) {
    if (auto stays = core::stays_in_folder(options.output, each); !stays) return stays;
  }
  return options.overwrite ? core::Status{} : check_own_files(paths, job);
}

/// Renders what strategy (s, t) brings to the picture, and writes it. False (and a message) where
/// that fails.
bool write_strategy(const std::shared_ptr<const core::Scene>& scene, core::Job job,
                    const StrategiesOptions& options, int s, int t, bool weighted,
                    const std::function<double(double share)>& of_all, ShareDone& done) {
  job.integrator.light_vertices = s;
  job.integrator.camera_vertices = t;
  job.integrator.min_events = job.integrator.max_depth = s + t - 2;
  job.integrator.mis = weighted;
  core::LayerSet layers;
  layers.splats = true;
  const std::string name =
      fmt::format("{}.s{}-t{}{}", job.name, s, t, weighted ? "" : ".unweighted");
  if (const auto may = may_write(options, name, job.name); !may) {
    print_error(may.error());
    return false;
  }
  const core::FrameRenderer renderer(scene, job, options.frame, layers);
  const core::RenderedFrame rendered = core::render_frame(
      renderer, core::render_window(job.film), job.sampling.samples, options.frame,
      {.threads = options.threads, .progress = [&](double share) { done.show(of_all(share)); }});
  core::OutputDesc exr;
  exr.file = name + ".exr";
  exr.layers = {"beauty", "variance"};
  core::OutputDesc png;
  png.file = name + ".png";
  core::FilmInfo info;
  info.job_name = job.name;
  info.frame = options.frame;
  info.width = job.film.width;
  info.height = job.film.height;
  info.crop = core::render_window(job.film);
  info.samples = job.sampling.samples;
  const core::OutputDesc outputs[] = {exr, png};
  const auto written = core::write_outputs(outputs, options.output, info, rendered.film);
  if (!written) print_error(written.error());
  done.clear();
  for (size_t i = 0; written && i < written->size(); ++i)
    std::printf("wrote %s\n", (*written)[i].c_str());
  return static_cast<bool>(written);
}

}  // namespace

/// `hyades strategies job.yaml`: what each strategy of bidirectional path tracing brings to a
/// picture, weighted and not.
int strategies_command(int argc, char** argv) {
  CLI::App app(
      "Renders what each strategy of bidirectional path tracing alone finds of a job's picture: "
      "paths of s vertices from the light and t from the camera, as weighted in the picture (their "
      "sum is the picture but for what shines into the camera itself) and unweighted.",
      "hyades strategies");
  StrategiesOptions options;
  std::string path;
  SceneOptions scene_options;
  uint32_t samples = 0;
  app.add_option("job", path, job_words())->required();
  declare_scene_options(app, scene_options);
  auto* frame = app.add_option("--frame", options.frame, "frame number (default: the job's first)");
  app.add_option("--events", options.events, "most scattering events")
      ->check(in_range(1, 16))
      ->capture_default_str();
  app.add_option("--samples", samples, "per pixel (default: the job's)")
      ->check(in_range(1U, 16'777'216U));
  declare_film_size(app, options.size);
  app.add_option("--threads", options.threads, "rendering threads")->check(in_range(1, 1024));
  declare_output_folder(app, options.output, "folder for the pictures");
  app.add_flag("--overwrite", options.overwrite,
               "replace files that are there, whoever made them (default: those of this job)");
  app.add_flag("-q,--quiet", options.quiet, "show no progress");
  app.footer(
      "examples:\n  hyades strategies jobs/cornell/job.yaml --events 2 --samples 64 --output "
      "parts\n"
      "exit status: 0 written, 1 a picture could not be written, 2 the job or the arguments are "
      "wrong");
  if (const auto status = parse_command_line(app, argc, argv, kBadInput)) return *status;
  auto loaded = load_job(path, scene_options);
  if (!loaded) return kBadInput;
  core::Job& job = loaded->job;
  if (frame->empty()) options.frame = job.frames.first;
  if (!is_in_range(job, options.frame)) return kBadInput;
  if (job.film.filter.type == core::FilterKind::center) {
    std::fprintf(stderr, "%s: film.filter is center, expected a filter with a radius\n",
                 path.c_str());
    return kBadInput;
  }
  if (samples > 0) job.sampling.samples = samples;
  resize_film(options.size, job.film);
  job.integrator.type = "bdpt";
  core::SceneCache cache(*loaded->assets);
  auto scene = core::build_scene(job, options.frame, cache);
  if (!scene) {
    print_error(scene.error());
    return 1;
  }
  for (const std::string& warning : (*scene)->warnings)
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  ShareDone done(options.quiet);
  int pictures = 0;
  const auto of_all = [&](double share) {
    return (pictures + share) / pictures_of(options.events);
  };
  for (int events = 1; events <= options.events; ++events) {
    for (int s = 0; s <= events + 1; ++s) {
      for (const bool weighted : {true, false}) {
        if (!write_strategy(*scene, job, options, s, events + 2 - s, weighted, of_all, done)) {
          return 1;
        }
        ++pictures;
      }
    }
  }
  return 0;
}

}  // namespace hyades::cli
