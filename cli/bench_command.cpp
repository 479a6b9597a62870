#include <chrono>
#include <cstdint>
#include <cstdio>
#include <set>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/film_room.h"
#include "cli/load_job.h"
#include "cli/number_range.h"
#include "cli/scene_options.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"

namespace hyades::cli {
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// 1, 2, 3, 4, 6, 8, 12, 16, ... up to `most`, and `most` itself.
std::set<int> thread_counts(int most) {
  std::set<int> counts{most};
  for (int power = 1; power <= most; power *= 2) {
    counts.insert(power);
    if (power >= 2 && power * 3 / 2 <= most) counts.insert(power * 3 / 2);
  }
  return counts;
}

int scaling(const std::string& path, const SceneOptions& scene_options, int most_threads,
            uint32_t samples) {
  using Clock = std::chrono::steady_clock;
  const auto load_begin = Clock::now();
  auto loaded = load_job(path, scene_options);
  if (!loaded) return kBadInput;
  core::Job& job = loaded->job;
  if (samples > 0) job.sampling.samples = samples;
  if (const auto fits = film_room(job, core::render_window(job.film)).check(); !fits) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(), fits.error().message.c_str());
    return kBadInput;
  }
  core::SceneCache cache(*loaded->assets);
  auto scene = core::build_scene(job, job.frames.first, cache);
  if (!scene) {
    print_error(scene.error());
    return 1;
  }
  std::printf("%s: %s triangles, %d x %d, %u samples; scene ready after %.3f s\n\n",
              job.name.c_str(), core::format_count((*scene)->triangles).c_str(), job.film.width,
              job.film.height, job.sampling.samples, seconds_since(load_begin));
  std::printf("threads   seconds   speed-up   efficiency   Msamples/s   Mrays/s   rays/sample\n");
  const core::FrameRenderer renderer(*scene, job, job.frames.first, {});
  const core::PixelRect window = core::render_window(job.film);
  double alone = 0.0;
  for (const int threads : thread_counts(most_threads)) {
    core::RenderFrameOptions options;
    options.threads = threads;
    const auto begin = Clock::now();
    const auto frame =
        core::render_frame(renderer, window, job.sampling.samples, job.frames.first, options);
    const double seconds = seconds_since(begin);
    if (alone == 0.0) alone = seconds;
    const auto samples_done = static_cast<double>(frame.counters.samples);
    const auto rays = static_cast<double>(frame.counters.rays);
    std::printf("%7d %9.3f %9.2fx %11.0f%% %12.3f %9.3f %13.2f\n", threads, seconds,
                alone / seconds, 100.0 * alone / seconds / threads, samples_done / seconds * 1e-6,
                rays / seconds * 1e-6, rays / samples_done);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

/// `hyades bench scaling [job.yaml]`: the table of how rendering speeds up with threads.
int bench_command(int argc, char** argv) {
  CLI::App app("Measures this machine.", "hyades bench");
  app.require_subcommand(1);
  std::string path = "jobs/mesh-100k/job.yaml";
  SceneOptions scene_options;
  int threads = core::hardware_threads();
  uint32_t samples = 0;
  auto* command =
      app.add_subcommand("scaling", "renders the first frame of a job with 1..N threads");
  command->add_option("job", path, job_words())->capture_default_str();
  declare_class_option(*command, scene_options);
  declare_scene_options(*command, scene_options);
  command->add_option("--threads", threads, "most threads")
      ->check(in_range(1, 1024))
      ->capture_default_str();
  command->add_option("--samples", samples, "samples per pixel (default: the job's)");
  app.footer(
      "examples:\n"
      "  hyades bench scaling\n"
      "  hyades bench scaling jobs/cornell/job.yaml --threads 8 --samples 64\n"
      "exit status: 0 measured, 2 the job or the arguments are wrong");
  if (const auto status = parse_command_line(app, argc, argv, kBadInput)) return *status;
  return scaling(path, scene_options, threads, samples);
}

}  // namespace hyades::cli
