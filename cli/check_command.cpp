#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/film_room.h"
#include "cli/frame_range.h"
#include "cli/load_job.h"
#include "cli/sample_cost.h"
#include "cli/scene_options.h"
#include "coordinator/local/local_plan.h"
#include "coordinator/scheduler/run_length.h"
#include "coordinator/scheduler/tile_grid.h"
#include "core/base/atomic_file.h"
#include "core/base/hash.h"
#include "core/base/machine.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/job/layers.h"
#include "core/job/noise_threshold.h"
#include "core/render/frame_renderer.h"
#include "core/scene/build_scene.h"
#include "core/scene/scene_files.h"

namespace hyades::cli {
namespace {

constexpr double kProbeSeconds = 0.7;

/// Reads all files that the job names and complains about what is wrong in them: of a good job,
/// those of its scene into `cache`; what nothing uses is not kept.
core::Status read_contents(const LoadedJob& loaded, core::SceneCache& cache,
                           core::Diagnostics& diagnostics) {
  core::SceneFiles others = core::files_of_job(loaded.job);
  if (diagnostics.empty()) {
    const core::SceneFiles scene = core::files_of_scene(loaded.job);
    if (auto done = core::load_files(scene, cache, diagnostics); !done) return done;
    others = core::without(std::move(others), scene);
  }
  // That a file is not there has been told.
  const auto is_missing = [&](const auto& file) { return !loaded.assets->open(file.file); };
  std::erase_if(others.meshes, is_missing);
  std::erase_if(others.images, is_missing);
  std::erase_if(others.light_maps, is_missing);
  core::SceneCache aside(*loaded.assets);
  return core::load_files(others, aside, diagnostics);
}

/// About how many units `render` cuts a frame into, where a sample takes `seconds` of one thread.
uint64_t units_per_frame(const core::Job& job, const coordinator::LocalPlan& plan, double seconds) {
  const coordinator::TileGrid grid(plan.region, plan.tile_size);
  const uint64_t batches = core::batch_count(plan.samples);
  const int64_t frames = frame_count(job.frames.first, job.frames.last, job.frames.step);
  const double pixels = static_cast<double>(plan.region.area()) / grid.size();
  const double batch = seconds * pixels * std::min(plan.samples, core::kBatchSamples);
  const uint64_t all = grid.size() * batches * static_cast<uint64_t>(frames);
  const uint64_t run = coordinator::run_length(std::max(batch, 1e-12), plan.unit_time, all,
                                               static_cast<uint64_t>(core::hardware_threads()));
  return grid.size() * ((batches + run - 1) / run);
}

/// "1,234,567", or "4.5e+22" of what is beyond exact counting.
std::string samples_in_words(double samples) {
  if (samples < 1e15) return core::format_count(static_cast<uint64_t>(samples));
  return fmt::format("{:.2g}", samples);
}

/// Years from one year on.
std::string duration_in_words(double hours) {
  const double years = hours / (24.0 * 365.25);
  if (years < 1.0) return core::format_duration(hours * 3600.0);
  return years < 1000.0 ? fmt::format("{:.1f} years", years) : fmt::format("{:.3g} years", years);
}

struct CheckOptions {
  std::string path;
  std::string curve;  ///< empty: the job is summed up
  bool no_probe = false;
  bool files = false;
  bool quiet = false;
  std::string made;  ///< folder; empty: what is made of scenes is written nowhere
  SceneOptions scene;
};

std::optional<int> parse_check_options(int argc, char** argv, CheckOptions& options) {
  CLI::App app(
      "Reads a job and reports every mistake in it; a good one is summed up: frames, triangles, "
      "units, and an estimate of memory and core-hours.",
      "hyades check");
  app.add_option("job", options.path, job_words())->required();
  app.add_option("--curve", options.curve,
                 "print this value of the job over its frames instead: camera.fov, "
                 "objects.NAME.at, objects.NAME.transform[0].rotate_y, materials.NAME.color, ...");
  app.add_flag("--files", options.files,
               "print the files that the job is read from instead, as JSON: its text first, then "
               "what it names, relative to its folder");
  app.add_option("--made", options.made,
                 "with --files, also write those that are made of scenes of other tools and lie on "
                 "no disk into this folder, each under its SHA-256")
      ->needs("--files")
      ->type_name("DIR");
  app.add_flag("--no-probe", options.no_probe, "do not render a few pixels to estimate the time");
  app.add_flag("-q,--quiet", options.quiet, "say nothing of a good job");
  app.footer(
      "examples:\n  hyades check jobs/cornell/job.yaml\nexit status: 0 good, 2 mistakes found");
  declare_class_option(app, options.scene);
  declare_scene_options(app, options.scene);
  return parse_command_line(app, argc, argv, kBadInput);
}

/// Of the job `name`, whose curve somebody wants to see.
core::Status print_curve(const core::Job& job, const std::string& name) {
  const auto found = core::find_curve(job, name);
  if (!found) return found.error().in("hyades check");
  std::fputs(core::curve_table(job, **found).c_str(), stdout);
  return {};
}

/// Every file that travels with the job, for programs that bring it to a farm.
core::Status print_files(const LoadedJob& loaded, const std::string& made) {
  core::RecordingResolver text(loaded.files->files());
  if (const auto opened = text.open(loaded.files->document()); !opened) return opened.error();
  std::vector<core::AssetRecord> all = text.records();
  for (const core::AssetRecord& asset : loaded.assets->records()) all.push_back(asset);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const core::AssetRecord& file : all) {
    list.push_back({{"path", file.reference}, {"sha256", file.sha256}, {"size", file.size}});
    // Of a .blend all is made, in a folder that goes when this program ends.
    const bool is_made = loaded.blend || loaded.files->is_made(file.reference);
    if (made.empty() || !is_made) continue;
    auto bytes = loaded.files->files().open(file.reference);
    if (!bytes) return bytes.error();
    const std::string path = (std::filesystem::path(made) / file.sha256).string();
    if (auto done = core::write_file(path, bytes->span()); !done) return done;
  }
  std::printf("%s\n", list.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  return {};
}

/// What a job holds and asks for, as far as no pixel has to be rendered.
void print_contents(const core::Job& job, const core::Scene& scene, double samples) {
  const core::PixelRect window = core::render_window(job.film);
  const int64_t frames = frame_count(job.frames.first, job.frames.last, job.frames.step);
  std::printf("  job        %s\n", job.name.c_str());
  std::printf("  frames     %s of %d x %d%s\n",
              core::format_count(static_cast<uint64_t>(frames)).c_str(), window.width(),
              window.height(), job.film.crop ? " (cropped)" : "");
  std::printf("  objects    %s, %s triangle%s, %s\n",
              core::format_count(scene.objects.size()).c_str(),
              core::format_count(scene.triangles).c_str(), scene.triangles == 1 ? "" : "s",
              core::counted(scene.lights.size(), "light").c_str());
  if (core::noise_threshold(job).adaptive()) {
    std::printf("  samples    at most %u per pixel, %s in all; tiles stop at a noise of %g\n",
                job.sampling.samples, samples_in_words(samples).c_str(),
                double{job.sampling.noise});
  } else {
    std::printf("  samples    %u per pixel, %s in all\n", job.sampling.samples,
                samples_in_words(samples).c_str());
  }
  std::printf("  batches    %s per frame, of %u samples of a pixel each\n",
              core::format_count(core::batch_count(job.sampling.samples)).c_str(),
              core::kBatchSamples);
}

/// Into how many units a frame is cut; `seconds` of one core per sample, where they are known.
void print_units(const core::Job& job, bool splats, std::optional<double> seconds) {
  coordinator::LocalPlan plan;
  plan.region = core::render_window(job.film);
  plan.samples = job.sampling.samples;
  if (splats) plan.tile_size = coordinator::kSplatTile;
  const uint64_t tiles = coordinator::TileGrid(plan.region, plan.tile_size).size();
  if (seconds) {
    std::printf("  units      about %s per frame (%s tile%s of %d x %d pixels, runs of batches)\n",
                core::format_count(units_per_frame(job, plan, *seconds)).c_str(),
                core::format_count(tiles).c_str(), tiles == 1 ? "" : "s", plan.tile_size,
                plan.tile_size);
  } else {
    const uint64_t most = tiles * core::batch_count(plan.samples);
    std::printf("  units      %s to %s per frame (tiles of %d x %d pixels)\n",
                core::format_count(tiles).c_str(), core::format_count(most).c_str(), plan.tile_size,
                plan.tile_size);
  }
}

void print_memory(const core::Job& job, const core::Scene& scene) {
  const FilmRoom room = film_room(job, core::render_window(job.film));
  const uint64_t geometry = scene.world->memory();
  const uint64_t memory = geometry + scene.texture_memory + room.film;
  std::printf("  memory     about %s (geometry %s, textures %s, film %s)\n",
              core::format_bytes(memory).c_str(), core::format_bytes(geometry).c_str(),
              core::format_bytes(scene.texture_memory).c_str(),
              core::format_bytes(room.film).c_str());
  for (const std::string& warning : scene.warnings) {
    std::printf("  warning    %s\n", warning.c_str());
  }
  if (const core::Status fits = room.check(); !fits) {
    std::printf("  warning    'hyades render' refuses it here: %s\n", fits.error().message.c_str());
  } else if (room.here > 0 && memory > room.here) {
    std::printf("  warning    there are %s of memory only\n",
                core::format_bytes(room.here).c_str());
  }
}

/// Sums up a good job; an error where its first frame cannot be built.
core::Status print_summary(const CheckOptions& options, const core::Job& job,
                           core::SceneCache& cache) {
  auto scene = core::build_scene(job, job.frames.first, cache);
  if (!scene) return scene.error();
  if (options.quiet) return {};
  const core::PixelRect window = core::render_window(job.film);
  const core::LayerSet layers = core::needed_layers(job);
  const core::FrameRenderer renderer(*scene, job, job.frames.first, layers);
  const int64_t frames = frame_count(job.frames.first, job.frames.last, job.frames.step);
  // In double: the largest jobs have more than 64 bits can count.
  const double samples =
      static_cast<double>(window.area()) * job.sampling.samples * static_cast<double>(frames);
  std::printf("%s: good\n", options.path.c_str());
  print_contents(job, **scene, samples);
  std::optional<double> seconds;
  bool dark = false;
  if (!options.no_probe) {
    const SampleCost cost = measure_sample_cost(renderer, window, job.frames.first, 1,
                                                kProbeSeconds, 4 * kProbeSeconds);
    seconds = cost.core_seconds;
    dark = !cost.lit;
  }
  print_units(job, layers.splats, seconds);
  print_memory(job, **scene);
  if (dark && (*scene)->warnings.empty()) {
    std::printf(
        "  warning    no light was found in the pixels that were tried: does any reach what the "
        "camera sees?\n");
  }
  if (seconds) {
    const double hours = *seconds * samples / 3600.0;
    const bool adaptive = core::noise_threshold(job).adaptive();
    std::printf("  cost       %s %s of one core like this one (%s core-hours)\n",
                adaptive ? "at most" : "about", duration_in_words(hours).c_str(),
                hours < 0.001 ? "< 0.001" : fmt::format("{:.3g}", hours).c_str());
  }
  return {};
}

}  // namespace

/// `hyades check job.yaml`: every mistake, or what the job is and would cost.
int check_command(int argc, char** argv) {
  CheckOptions options;
  if (const auto status = parse_check_options(argc, argv, options)) return *status;
  core::Diagnostics diagnostics;
  auto loaded = read_job_file(options.path, diagnostics, options.scene);
  if (!loaded) return kBadInput;
  core::SceneCache cache(*loaded->assets);
  core::Status done;
  if (!options.files) done = read_contents(*loaded, cache, diagnostics);
  if (done && !diagnostics.empty()) {
    std::fputs(diagnostics.to_string().c_str(), stderr);
    return kBadInput;
  }
  if (done && options.files) {
    done = print_files(*loaded, options.made);
  } else if (done) {
    done = options.curve.empty() ? print_summary(options, loaded->job, cache)
                                 : print_curve(loaded->job, options.curve);
  }
  if (done) return 0;
  print_error(done.error());
  return kBadInput;
}

}  // namespace hyades::cli
