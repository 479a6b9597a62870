#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <span>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/film_room.h"
#include "cli/frame_range.h"
#include "cli/interrupt.h"
#include "cli/job_frames.h"
#include "cli/load_job.h"
#include "cli/progress_display.h"
#include "coordinator/local/local_run.h"
#include "coordinator/scheduler/tile_grid.h"
#include "core/base/atomic_file.h"
#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/job/layers.h"
#include "core/render/chain_batch.h"

namespace hyades::cli {
namespace {

struct RenderOptions {
  std::string path;
  std::string frames;
  std::string folder = ".";
  std::string media;
  std::string save_job;
  int threads = core::hardware_threads();
  uint32_t samples = 0;
  uint64_t film_memory = 0;  ///< bytes; 0: what the machine is good for
  std::vector<int> crop;
  bool resume = false;
  bool quiet = false;
  bool film = false;
};

/// Exit status other than 0 where the arguments end the command.
std::optional<int> parse_arguments(int argc, char** argv, RenderOptions& options) {
  CLI::App app("Renders a job (or a mesh file) on this machine.", "hyades render");
  app.add_option("job", options.path, "the job (.yaml) or mesh (.obj, .ply)")->required();
  app.add_option("--media", options.media,
                 "of a mesh: file of media (.json, .yaml) that fill its materials (usemtl) of the "
                 "same names");
  app.add_option("--save-job", options.save_job,
                 "of a mesh: write the job that it is rendered as, and render nothing");
  app.add_option("--frames", options.frames,
                 "frames to render: 7, 1-10 or 1-10x2 (default: all; at most a million)")
      ->check(no_frames_error);
  app.add_option("--samples", options.samples, "samples per pixel (default: the job's)")
      ->check(CLI::Range(1U, 1U << 24U));
  app.add_option("--crop", options.crop, "X0,Y0,X1,Y1: render only these pixels")
      ->delimiter(',')
      ->expected(4);
  app.add_option("--threads", options.threads, "rendering threads")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--film-memory", options.film_memory,
                 "most memory that films may take, such as 8G; jobs of larger ones are refused "
                 "(default: half of what is here)")
      ->transform(CLI::AsSizeValue(false));
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
      "  hyades render dragon.ply --samples 64\n"
      "  hyades render bottles.obj --media media.json\n"
      "Ctrl-C stops; --resume continues, also after a crash.\n"
      "exit status: 0 done, 1 something failed, 2 the job or the arguments are wrong, 130 "
      "interrupted");
  return parse_command_line(app, argc, argv, kBadInput);
}

/// The job as the command line changes it; nothing (and a message) where that makes no sense.
std::optional<LoadedJob> load(const RenderOptions& options) {
  auto loaded = load_job(options.path, options.media);
  if (!loaded) return std::nullopt;
  core::Job& job = loaded->job;
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

/// What is rendered of each frame. --crop is no part of the job: films of several crops belong to
/// one picture, and 'hyades merge' joins them.
core::PixelRect window_of(const RenderOptions& options, const core::Job& job) {
  const core::PixelRect whole = core::render_window(job.film);
  if (options.crop.empty()) return whole;
  return intersection(whole, {options.crop[0], options.crop[1], options.crop[2], options.crop[3]});
}

/// Says so where what the job's chains bring to the crop is right only when the rest is merged.
void note_cut_chains(const RenderOptions& options, const core::Job& job) {
  if (options.crop.empty() || options.quiet || job.integrator.type != "mlt") return;
  const core::PixelRect crop = window_of(options, job);
  const auto pixels = static_cast<double>(crop.area());
  const auto stood_for =
      static_cast<double>(core::pixels_of_chains(crop, core::render_window(job.film)));
  if (stood_for == pixels) return;
  std::fprintf(
      stderr,
      "--crop: chains of mlt stand for %d x %d pixels each, and this crop cuts some: until it "
      "is merged with the rest its light is %.3g times what it should be; edges at "
      "multiples of %d cut none\n",
      core::kChainShare, core::kChainShare, stood_for / pixels, core::kChainShare);
}

/// Writes the job that the mesh is rendered as; the exit status.
int save_job(const RenderOptions& options) {
  if (!is_mesh(options.path)) {
    std::fprintf(stderr, "%s: --save-job is for meshes (.obj, .ply)\n", options.path.c_str());
    return kBadInput;
  }
  const std::string folder = std::filesystem::path(options.save_job).parent_path().string();
  const auto text = text_of_mesh_job(options.path, options.media, folder);
  if (!text) {
    std::fprintf(stderr, "%s\n", text.error().message.c_str());
    return kBadInput;
  }
  if (auto written = core::write_file(options.save_job, std::as_bytes(std::span(*text)));
      !written) {
    std::fprintf(stderr, "%s\n", written.error().message.c_str());
    return 1;
  }
  if (!options.quiet) std::fprintf(stderr, "wrote %s\n", options.save_job.c_str());
  return 0;
}

/// Remembers how outputs were made, so that a resumed run does not take pictures for finished that
/// were made with another exposure, say.
class OutputNote {
 public:
  OutputNote(std::string path, const core::Job& job) : path_(std::move(path)) {
    std::string settings;
    for (const core::OutputDesc& output : job.outputs) {
      settings += fmt::format("{}|{}|{}|{}|{}|{}\n", output.file, fmt::join(output.layers, ","),
                              output.tone_map, output.exposure, output.half, output.transparent);
    }
    digest_ = core::to_hex(core::sha256(settings));
  }

  /// Whether an earlier run noted the same settings.
  bool still_true() const {
    std::ifstream file(path_);
    std::string noted;
    return std::getline(file, noted) && noted == digest_;
  }

  /// Without the note a later run only makes the outputs again, so failing to write it is no error.
  void write() const { (void)core::write_file(path_, std::as_bytes(std::span(digest_))); }

 private:
  std::string path_;
  std::string digest_;
};

void print_bad_samples(const RunTotals& totals, const std::string& path) {
  if (totals.counters.bad_samples == 0) return;
  std::fprintf(stderr, "%s samples were %s and count as black. To see why:\n",
               core::format_count(totals.counters.bad_samples).c_str(),
               core::bad_sample_words().c_str());
  for (const RunTotals::Bad& bad : totals.bad) {
    std::fprintf(stderr, "  hyades replay %s --frame %d --pixel %d,%d --sample %u\n", path.c_str(),
                 bad.frame, bad.sample.pixel.x, bad.sample.pixel.y, bad.sample.sample);
  }
}

/// The first of `numbers` whose outputs are there.
std::optional<int32_t> first_written(const std::vector<int32_t>& numbers,
                                     const coordinator::LocalOutcome& outcome) {
  std::set<int32_t> failed;
  for (const coordinator::FrameFailure& failure : outcome.failures) failed.insert(failure.frame);
  const auto first = std::find_if(numbers.begin(), numbers.end(),
                                  [&](int32_t frame) { return !failed.contains(frame); });
  return first == numbers.end() ? std::nullopt : std::optional(*first);
}

int report(const RenderOptions& options, const JobFrames& frames,
           const std::vector<int32_t>& numbers, const coordinator::LocalOutcome& outcome,
           const coordinator::Progress& progress) {
  const RunTotals totals = frames.totals();
  print_bad_samples(totals, options.path);
  for (const coordinator::FrameFailure& failure : outcome.failures) {
    std::fprintf(stderr, "frame %d failed: %s\n", failure.frame, failure.reason.c_str());
  }
  if (!outcome.error.empty()) {
    std::fprintf(stderr, "%s\nwhat is done is kept: continue with --resume\n",
                 outcome.error.c_str());
    return 1;
  }
  if (!outcome.complete) {
    std::fputs(kInterruptedWords, stderr);
    return kInterrupted;
  }
  const auto first = first_written(numbers, outcome);
  if (!options.quiet && first) {
    const std::string others =
        outcome.frames_done > 1 ? fmt::format(" ... ({} frames)", outcome.frames_done) : "";
    for (const std::string& path : frames.output_paths(*first)) {
      std::fprintf(stderr, "wrote %s%s\n", path.c_str(), others.c_str());
    }
    const auto samples = static_cast<double>(totals.counters.samples);
    std::fprintf(stderr, "%s, %.2f Msamples/s, %.2f Mrays/s, %.1f rays per sample\n",
                 core::format_duration(progress.elapsed).c_str(), samples / progress.elapsed * 1e-6,
                 static_cast<double>(totals.counters.rays) / progress.elapsed * 1e-6,
                 samples > 0 ? static_cast<double>(totals.counters.rays) / samples : 0.0);
  }
  return outcome.failures.empty() ? 0 : 1;
}

}  // namespace

/// `hyades render job.yaml`.
int render_command(int argc, char** argv) {
  const auto begin = std::filesystem::file_time_type::clock::now();
  RenderOptions options;
  if (const auto status = parse_arguments(argc, argv, options)) return *status;
  if (!options.save_job.empty()) return save_job(options);
  auto loaded = load(options);
  if (!loaded) return kBadInput;
  const core::Job& job = loaded->job;
  const auto numbers = select_frames(job, options.frames);
  if (!numbers) return kBadInput;

  note_cut_chains(options, job);
  const core::PixelRect window = window_of(options, job);
  const FilmRoom room = film_room(job, window, options.film_memory);
  if (const auto fits = room.check(); !fits) {
    std::fprintf(stderr, "%s: %s\n", options.path.c_str(), fits.error().message.c_str());
    return kBadInput;
  }
  const std::string kept = options.folder + "/.hyades/" + job.name;
  const OutputNote note(kept + ".outputs", job);
  JobFrames frames(*loaded,
                   {options.folder, options.film || job.keep_films, window, note.still_true()});
  if (const auto names = frames.check_film_names(); !names) {
    std::fprintf(stderr, "%s\n", names.error().message.c_str());
    return kBadInput;
  }
  // No frame could be rendered without them.
  if (const auto files = frames.load_files(); !files) {
    std::fprintf(stderr, "%s\n", files.error().message.c_str());
    return kBadInput;
  }
  // Nor, mostly, where the first one cannot. A resumed run may have it behind it.
  if (!options.resume || !frames.outputs_exist(numbers->front())) {
    const auto warnings = frames.load_first(numbers->front());
    if (!warnings) {
      std::fprintf(stderr, "%s\n", warnings.error().message.c_str());
      return kBadInput;
    }
    for (const std::string& warning : *warnings)
      std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
  std::error_code failed;
  for (const std::string& own : {options.folder + "/.hyades", kept}) {
    if (!std::filesystem::is_symlink(own, failed)) continue;
    std::fprintf(stderr, "%s: a symbolic link, expected a folder of the run's own (or none)\n",
                 own.c_str());
    return kBadInput;
  }
  const bool begins_over = !options.resume && std::filesystem::exists(kept, failed);
  std::filesystem::create_directories(options.folder, failed);
  if (failed) {
    std::fprintf(stderr, "%s: the folder could not be made: %s\n", options.folder.c_str(),
                 failed.message().c_str());
    return 1;
  }
  coordinator::LocalPlan plan;
  plan.frames = *numbers;
  plan.region = window;
  plan.samples = job.sampling.samples;
  plan.threads = options.threads;
  if (core::makes_splats(job.integrator)) plan.tile_size = coordinator::kSplatTile;
  plan.frames_in_flight = room.frames_in_flight();
  coordinator::LocalLog log;
  log.folder = kept;
  log.frame_key = [&frames](int32_t frame) { return frames.frame_key(frame); };
  log.resume = options.resume;

  // What is durable is safe however the process ends.
  watch_for_interrupts();
  coordinator::LocalRun run(plan, log, frames, frames);
  if (auto started = run.start(); !started) {
    std::fprintf(stderr, "%s\n", started.error().message.c_str());
    return 1;
  }
  if (begins_over) {
    std::fprintf(stderr,
                 "the work kept from an earlier run is given up; --resume would have "
                 "gone on with it\n");
  }
  // The log is ours now, so nobody else writes these files.
  frames.remove_leftovers(*numbers, begin);
  note.write();
  for (const std::string& problem : run.log_problems())
    std::fprintf(stderr, "%s\n", problem.c_str());
  ProgressDisplay display(job.name, options.quiet);
  bool stopping = false;
  while (!run.wait_for(std::chrono::milliseconds(50))) {
    if (interrupted() && !stopping) {
      stopping = true;
      run.stop();
    }
    display.update(run.progress());
  }
  display.clear();
  const coordinator::LocalOutcome outcome = run.outcome();
  const int status = report(options, frames, *numbers, outcome, run.progress());
  // Everything is written: the films are of no more use. After --frames the log may hold work on
  // other frames.
  const bool all_frames = static_cast<int64_t>(numbers->size()) ==
                          frame_count(job.frames.first, job.frames.last, job.frames.step);
  if (outcome.complete && outcome.failures.empty() && all_frames) {
    std::filesystem::remove_all(log.folder, failed);
    std::filesystem::remove(kept + ".outputs", failed);
    std::filesystem::remove(options.folder + "/.hyades",
                            failed);  // only where no other job is in it
  }
  std::fflush(nullptr);
  // An orderly end waits for frames that are loading or finishing; after Ctrl-C nobody wants to.
  if (stopping) _exit(status);
  return status;
}

}  // namespace hyades::cli
