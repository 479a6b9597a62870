#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "cli/command_line.h"
#include "cli/display/shown_films.h"
#include "cli/film_room.h"
#include "cli/frame_range.h"
#include "cli/interrupt.h"
#include "cli/job_frames.h"
#include "cli/json_report.h"
#include "cli/load_job.h"
#include "cli/output_note.h"
#include "cli/progress_display.h"
#include "cli/render_options.h"
#include "cli/time_limit.h"
#include "cli/videos.h"
#include "coordinator/film_store/film_log.h"
#include "coordinator/local/local_run.h"
#include "coordinator/scheduler/tile_grid.h"
#include "core/base/atomic_file.h"
#include "core/base/folder_links.h"
#include "core/base/io_reason.h"
#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/film/black.h"
#include "core/job/layers.h"
#include "core/job/noise_threshold.h"
#include "core/render/chain_batch.h"

namespace hyades::cli {
namespace {

/// Says so where what the job's chains bring to the crop is right only when the rest is merged.
void note_cut_chains(const RenderOptions& options, const core::Job& job) {
  const bool cut = !options.crop.empty() || options.tile;
  if (!cut || options.quiet || job.integrator.type != "mlt") return;
  const core::PixelRect crop = window_of(options, job);
  const auto pixels = static_cast<double>(crop.area());
  const auto stood_for =
      static_cast<double>(core::pixels_of_chains(crop, core::render_window(job.film)));
  if (stood_for == pixels) return;
  std::fprintf(stderr,
               "chains of mlt stand for %d x %d pixels each, and this part cuts some: until it "
               "is merged with the rest its light is %.3g times what it should be; edges at "
               "multiples of %d cut none\n",
               core::kChainShare, core::kChainShare, stood_for / pixels, core::kChainShare);
}

void print_bad_samples(const RunTotals& totals, const std::string& path) {
  if (totals.counters.bad_samples == 0) return;
  std::fprintf(stderr, "%s samples were %s and count as black. To see why:\n",
               core::format_count(totals.counters.bad_samples).c_str(),
               core::bad_sample_words().c_str());
  for (const RunTotals::Bad& bad : totals.bad) {
    std::fprintf(stderr, "  hyades replay %s --frame %d --pixel %d,%d --sample %u\n",
                 core::printable(core::shell_word(path)).c_str(), bad.frame, bad.sample.pixel.x,
                 bad.sample.pixel.y, bad.sample.sample);
  }
}

/// A picture without any light, or nearly so, is seldom meant. Parts of one may be dark.
void warn_of_frames(const RenderOptions& options, std::vector<int32_t> frames, const char* what) {
  if (frames.empty() || options.is_part() || !options.crop.empty()) return;
  std::sort(frames.begin(), frames.end());
  const std::string which = frames.size() == 1 ? fmt::format("frame {} is", frames.front())
                                               : fmt::format("{} frames, {} the first, are",
                                                             frames.size(), frames.front());
  std::fprintf(stderr, "warning: %s %s\n", which.c_str(), what);
}

/// Those of `numbers` whose outputs are there.
std::vector<int32_t> written_frames(std::vector<int32_t> numbers,
                                    const coordinator::LocalOutcome& outcome) {
  std::set<int32_t> failed;
  for (const coordinator::FrameFailure& failure : outcome.failures) failed.insert(failure.frame);
  std::erase_if(numbers, [&](int32_t frame) { return failed.contains(frame); });
  return numbers;
}

/// An interrupt is answered with how far the run has come.
void note_share(const RenderOptions& options, const coordinator::Progress& progress) {
  const char* kept = options.keep_work ? ": what is done is kept, the same command goes on" : "";
  set_interrupted_words(fmt::format("interrupted at {}{}\n", percent_done(progress), kept));
}

/// After what went wrong: what helps.
void note_kept(const RenderOptions& options, const FilmRoom& room) {
  if (!options.keep_work) return;
  std::fprintf(stderr,
               "what is done is kept: the same command goes on. Until a frame is written its film "
               "lies in %s/.hyades, up to %s; --no-resume --restart keeps none\n",
               options.folder.c_str(), core::format_bytes(room.film).c_str());
}

/// What the pictures of `frames` frames may take on the disk, in bytes, before they are packed.
uint64_t picture_bytes(const core::Job& job, const FilmRoom& room, size_t frames) {
  uint64_t each = 0;  // of a pixel
  for (const core::OutputDesc& output : job.outputs) {
    each += core::file_extension(output.file) == ".exr" ? 4 * room.channels : 4;
  }
  return each * static_cast<uint64_t>(room.window.area()) * frames;
}

/// Before it is waited for, or all was in vain: a disk that may have no room for what a run keeps
/// of a frame, or for what it writes.
void warn_of_full_disk(const RenderOptions& options, const FilmRoom& room, const core::Job& job,
                       size_t frames) {
  std::error_code failed;
  std::filesystem::path there = std::filesystem::absolute(options.folder, failed);
  while (there.has_relative_path() && !std::filesystem::exists(there, failed)) {
    there = there.parent_path();
  }
  const auto space = std::filesystem::space(there, failed);
  if (failed) return;
  const std::string left =
      fmt::format("warning: the disk of {} has {} left, and ", core::printable(options.folder),
                  core::format_bytes(space.available));
  const uint64_t pictures = options.is_part() ? 0 : picture_bytes(job, room, frames);
  if (options.keep_work && space.available < room.film) {
    std::fprintf(stderr,
                 "%sa frame's film may take up to %s there until the frame is written; "
                 "--no-resume keeps none\n",
                 left.c_str(), core::format_bytes(room.film).c_str());
  } else if (space.available < pictures) {
    std::fprintf(stderr, "%swhat is written may take up to %s\n", left.c_str(),
                 core::format_bytes(pictures).c_str());
  }
}

int report(const RenderOptions& options, const FilmRoom& room, const JobFrames& frames,
           const std::vector<int32_t>& numbers, const coordinator::LocalRun& run,
           const JsonReport& json) {
  const coordinator::LocalOutcome outcome = run.outcome();
  const coordinator::Progress progress = run.progress();
  const RunTotals totals = frames.totals();
  print_bad_samples(totals, options.path);
  warn_of_frames(options, totals.black, core::kBlackWords);
  warn_of_frames(options, totals.dim,
                 "nearly black: brighter lights, or the 'exposure' of outputs, would show more");
  for (const coordinator::FrameFailure& failure : outcome.failures) {
    print_error(core::Error{fmt::format("frame {} failed: {}", failure.frame, failure.reason)});
  }
  if (!outcome.error.empty()) print_error(core::Error{outcome.error});
  const bool full =
      std::any_of(outcome.failures.begin(), outcome.failures.end(),
                  [](const coordinator::FrameFailure& failure) {
                    return failure.reason.find(core::io_reason(ENOSPC)) != std::string::npos;
                  });
  if (!outcome.error.empty() || full) note_kept(options, room);
  if (!outcome.error.empty()) return 1;
  if (!outcome.complete) {
    note_share(options, progress);
    std::fputs(interrupted_words(), stderr);
    return kInterrupted;
  }
  const std::vector<int32_t> written = written_frames(numbers, outcome);
  for (const int32_t frame : written) json.written(frame, frames.output_paths(frame, false));
  if (!options.quiet && !written.empty() && progress.frames_done > run.before().frames_done) {
    const std::string others =
        outcome.frames_done > 1 ? fmt::format(" ... ({} frames)", outcome.frames_done) : "";
    for (const std::string& path : frames.output_paths(written.front(), false)) {
      std::fprintf(stderr, "wrote %s%s\n", path.c_str(), others.c_str());
    }
  }
  const auto samples = static_cast<double>(totals.counters.samples);
  if (!options.quiet && !written.empty() && samples > 0) {
    const auto rays = static_cast<double>(totals.counters.rays);
    std::fprintf(stderr, "%s, %s, %s, %.1f rays per sample\n",
                 core::format_duration(progress.elapsed).c_str(),
                 core::format_rate(samples / progress.elapsed, "samples").c_str(),
                 core::format_rate(rays / progress.elapsed, "rays").c_str(), rays / samples);
  }
  return outcome.failures.empty() ? 0 : 1;
}

/// Says what is wrong.
int refuse(const core::Error& error, int status = kBadInput) {
  std::fprintf(stderr, "%s\n", core::printable_lines(error.message).c_str());
  return status;
}

core::Status check_film_file(const std::string& file, size_t frames) {
  if (frames < 2 || file.empty() || file.find('#') != std::string::npos) return {};
  return core::Error{fmt::format(
      "--film {}: expected #### in the name, for the frame: there are {}", file, frames)};
}

/// Reads what no frame could be rendered without.
core::Status load_inputs(JobFrames& frames, bool goes_on, int32_t first) {
  if (auto names = frames.check_film_names(); !names) return names;
  if (auto files = frames.load_files(); !files) return files;
  // A resumed run may have its first frame behind it.
  if (goes_on && frames.outputs_exist(first)) return {};
  const auto warnings = frames.load_first(first);
  if (!warnings) return warnings.error();
  for (const std::string& warning : *warnings) {
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
  return {};
}

/// The folders may have come with somebody's scene, and what is in them is written to.
core::Status check_own_folders(const std::string& folder, const std::string& kept) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const auto is_own = [&](const fs::path& path) {
    const fs::file_type type = fs::symlink_status(path, failed).type();
    return type == fs::file_type::directory || type == fs::file_type::regular ||
           type == fs::file_type::not_found;
  };
  const auto refuse = [](const fs::path& path) {
    return core::Error{path.string() +
                       ": neither a file nor a folder that can be listed, expected what an earlier "
                       "run has kept, or nothing"};
  };
  for (const std::string& own : {folder + "/.hyades", kept}) {
    if (!is_own(own)) return refuse(own);
    for (fs::directory_iterator entry(own, failed); !failed && entry != fs::directory_iterator();
         entry.increment(failed)) {
      if (!is_own(entry->path())) return refuse(entry->path());
    }
    // What may not be listed may be opened by its name.
    if (failed && !core::is_not_there(failed)) return refuse(own);
  }
  return {};
}

coordinator::LocalPlan plan_of(const RenderOptions& options, const core::Job& job,
                               const std::vector<int32_t>& numbers, const FilmRoom& room) {
  coordinator::LocalPlan plan;
  plan.frames = numbers;
  plan.region = room.window;
  plan.samples = job.sampling.samples;
  plan.batches = batches_of(options, job);
  plan.threshold = core::noise_threshold(job);
  if (plan.threshold.adaptive()) plan.tile_size = core::kJudgedTile;
  plan.threads = options.threads;
  if (core::makes_splats(job.integrator)) plan.tile_size = coordinator::kSplatTile;
  plan.frames_in_flight = room.frames_in_flight();
  return plan;
}

/// Until the run has ended, shows how far it is; false where somebody interrupted it.
bool follow(const RenderOptions& options, coordinator::LocalRun& run, const std::string& name,
            Viewer* viewer, JsonReport& json) {
  ProgressDisplay display(name, options.quiet);
  const auto tell_of_viewer = [&] {
    const auto notice = viewer != nullptr ? viewer->take_notice() : std::nullopt;
    if (!notice) return;
    display.clear();
    std::fprintf(stderr, "%s\n", notice->c_str());
  };
  const auto tell_of_frames = [&] {
    for (const coordinator::FrameTime& frame : run.take_finished()) {
      if (options.quiet || run.progress().frames < 2) continue;
      display.clear();
      std::fprintf(stderr, "frame %d took %s\n", frame.frame,
                   core::format_duration(frame.seconds).c_str());
    }
  };
  bool stopping = false;
  while (!run.wait_for(std::chrono::milliseconds(50))) {
    if (interrupted() && !stopping) {
      stopping = true;
      run.stop();
    }
    tell_of_viewer();
    tell_of_frames();
    const coordinator::Progress progress = run.progress();
    note_share(options, progress);
    display.update(progress);
    json.progress(progress);
  }
  display.clear();
  tell_of_viewer();
  tell_of_frames();
  return !stopping;
}

/// Makes the videos of a run that has rendered all frames `numbers`; nothing, or the exit status
/// where that failed.
std::optional<int> make_videos_of_run(const RenderOptions& options, const core::Job& job,
                                      const std::vector<int32_t>& numbers) {
  if (make_videos(job, options.folder, numbers, options.quiet)) return std::nullopt;
  std::fprintf(stderr,
               "all frames are rendered and their pictures are kept: 'hyades video %s --output "
               "%s' (or the same command) goes on\n",
               core::printable(core::shell_word(options.path)).c_str(),
               core::printable(core::shell_word(options.folder)).c_str());
  return interrupted() ? kInterrupted : 1;
}

/// What only a resumed run would have needed.
void remove_kept(const RenderOptions& options, const std::string& kept) {
  std::error_code ignored;
  std::filesystem::remove_all(kept, ignored);
  std::filesystem::remove(kept + ".outputs", ignored);
  std::filesystem::remove(kept + ".time", ignored);
  // Only where no other job is in it.
  std::filesystem::remove(options.folder + "/.hyades", ignored);
}

/// Videos, and the removal of what is of no more use once all is written.
int finish_run(const RenderOptions& options, const core::Job& job,
               const std::vector<int32_t>& numbers, const std::string& kept,
               const JsonReport& json) {
  const bool all_frames = core::are_all_frames(job, numbers);
  const bool videos = !job.videos.empty() && !options.is_part();
  if (videos && all_frames) {
    if (const auto failed = make_videos_of_run(options, job, numbers)) return *failed;
    for (const core::VideoDesc& video : job.videos) {
      json.written(std::nullopt, {options.folder + "/" + video.file});
    }
  } else if (videos && !options.quiet) {
    note_no_videos(job, options.folder, options.path);
  }
  // After --frames the log may hold work on other frames, but for those of a part.
  if (!all_frames && !options.is_part() && options.crop.empty()) return 0;
  remove_kept(options, kept);
  if (!videos || !all_frames) return 0;
  // Not earlier: a resumed run would have missed them.
  for (const core::VideoDesc& video : job.videos) {
    core::remove_video_pictures(video, core::video_frames(job, options.folder, numbers));
  }
  return 0;
}

/// A run that keeps nothing makes no use of what an earlier one has kept: that goes where it was
/// asked for, and leaves its room on the disk.
core::Status give_up_kept(const RenderOptions& options, const std::string& kept) {
  std::error_code failed;
  if (options.keep_work || !std::filesystem::exists(kept, failed)) return {};
  if (!options.restart) {
    return core::Error{kept +
                       ": an earlier run has kept its work here; without --no-resume it is gone on "
                       "with, --no-resume --restart gives it up"};
  }
  if (core::Status erased = coordinator::erase_film_log(kept); !erased) return erased;
  remove_kept(options, kept);
  return {};
}

coordinator::KeptFilms kept_films(const RenderOptions& options) {
  if (options.restart) return coordinator::KeptFilms::erase;
  return options.resume ? coordinator::KeptFilms::require : coordinator::KeptFilms::use;
}

/// Says so where an earlier run has begun what this one goes on with.
void note_begun(const coordinator::Progress& progress) {
  if (progress.samples_done == 0) return;
  if (progress.frames_done == progress.frames) {
    std::fprintf(stderr, "rendered by an earlier run (--restart renders again)\n");
  } else {
    std::fprintf(stderr, "goes on at %s with what an earlier run has kept (--restart does not)\n",
                 percent_done(progress).c_str());
  }
}

/// Gives the job as many samples as --time has room for.
core::Status keep_to_time(const RenderOptions& options, TimeLimit& limit, JobFrames& frames,
                          const std::vector<int32_t>& numbers, core::Job& job) {
  const auto chosen = limit.samples(frames, numbers);
  if (!chosen) return chosen.error();
  job.sampling.samples = *chosen;
  if (options.quiet) return {};
  std::fprintf(stderr, "--time: %s per pixel (--samples %u renders the same)\n",
               core::counted(*chosen, "sample").c_str(), *chosen);
  return {};
}

/// Renders what has been found good; the exit status.
int run_frames(const RenderOptions& options, const core::Job& job, const FilmRoom& room,
               const std::vector<int32_t>& numbers, JobFrames& frames, const OutputNote& note,
               const TimeLimit& limit, const std::string& kept) {
  const auto begin = std::filesystem::file_time_type::clock::now();
  std::error_code failed;
  std::filesystem::create_directories(options.folder, failed);
  if (failed) {
    return refuse({options.folder + ": the folder could not be made: " + failed.message()}, 1);
  }
  if (!job.videos.empty() && !options.is_part() && !core::have_ffmpeg()) {
    std::fprintf(stderr, "warning: %s; until then frames' pictures are kept for its videos\n",
                 core::kNoFfmpeg);
  }
  coordinator::FilmStoreOptions log;
  if (options.keep_work) log.folder = kept;
  log.frame_key = [&frames](int32_t frame) { return frames.frame_key(frame); };
  log.kept = kept_films(options);
  // What is durable is safe however the process ends.
  watch_for_interrupts();
  std::optional<Viewer> viewer;
  std::optional<ShownFilms> shown;
  if (!options.display.empty()) {
    viewer.emplace(options.display);
    shown.emplace(*viewer, job.name, job.frames.first != job.frames.last);
  }
  coordinator::LocalRun run(plan_of(options, job, numbers, room), log, frames, frames,
                            shown ? &*shown : nullptr);
  if (auto started = run.start(); !started) return refuse(started.error(), 1);
  // The log is ours now, so nobody else writes these files.
  frames.remove_leftovers(numbers, begin);
  note.write();
  // Of what it writes a later run of the whole must not think that it is finished.
  if (!options.crop.empty()) {
    std::filesystem::remove(options.folder + "/.hyades/" + job.name + ".outputs", failed);
  }
  limit.write();
  for (const std::string& problem : run.log_problems()) {
    std::fprintf(stderr, "%s\n", problem.c_str());
  }
  if (!options.quiet) note_begun(run.before());
  JsonReport json(options.json);
  const bool to_its_end = follow(options, run, job.name, viewer ? &*viewer : nullptr, json);
  int status = report(options, room, frames, numbers, run, json);
  const coordinator::LocalOutcome outcome = run.outcome();
  if (outcome.complete && outcome.failures.empty()) {
    status = finish_run(options, job, numbers, kept, json);
  }
  std::fflush(nullptr);
  // An orderly end waits for frames that are loading or finishing; after Ctrl-C nobody wants to.
  if (!to_its_end) _exit(status);
  return status;
}

}  // namespace

/// `hyades render job.yaml`.
int render_command(int argc, char** argv) {
  const auto began = std::chrono::steady_clock::now();
  RenderOptions options;
  if (const auto status = parse_render_options(argc, argv, options)) return *status;
  auto loaded = load_for_render(options);
  if (!loaded) return kBadInput;
  const core::Job& job = loaded->job;
  if (options.preview > 0 && options.frames.empty())
    options.frames = std::to_string(job.frames.first);
  const auto numbers = select_frames(job, options.frames);
  if (!numbers) return kBadInput;

  note_cut_chains(options, job);
  const core::PixelRect window = window_of(options, job);
  const FilmRoom room = film_room(job, window, options.film_memory);
  if (const auto fits = room.check(); !fits) return refuse(fits.error().in(options.path));
  const std::string film_file = film_file_of(options, job);
  if (const auto named = check_film_file(film_file, numbers->size()); !named) {
    return refuse(named.error());
  }
  const std::string kept = options.folder + "/.hyades/" + kept_name(options, job);
  if (const auto own = check_own_folders(options.folder, kept); !own) return refuse(own.error());
  const OutputNote note(kept + ".outputs", *loaded);
  JobFrames frames(*loaded,
                   {options.folder, options.film || job.keep_films || options.is_part(), film_file,
                    options.is_part(), window, note.still_true(), options.texture_memory});
  if (const auto ready = load_inputs(frames, !options.restart, numbers->front()); !ready) {
    return refuse(ready.error());
  }
  if (const auto may = frames.check_outputs(*numbers, options.overwrite); !may) {
    return refuse(may.error());
  }
  if (const auto gone = give_up_kept(options, kept); !gone) return refuse(gone.error());
  warn_of_full_disk(options, room, job, numbers->size());
  TimeLimit limit(options, kept + ".time", began);
  if (options.time > 0) {
    const auto chosen = keep_to_time(options, limit, frames, *numbers, loaded->job);
    if (!chosen) return refuse(chosen.error());
  }
  if (options.preview == 0 && !options.overwrite) {
    if (const auto may = frames.check_not_lessened(*numbers); !may) return refuse(may.error());
  }
  return run_frames(options, job, room, *numbers, frames, note, limit, kept);
}

}  // namespace hyades::cli
