// `hyades finish job.yaml FILM...`: the pictures of frames whose films others have rendered.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/film_size_option.h"
#include "cli/interrupt.h"
#include "cli/job_frames.h"
#include "cli/join_films.h"
#include "cli/load_job.h"
#include "cli/number_range.h"
#include "cli/videos.h"
#include "cli/written_file.h"
#include "core/base/fp_mode.h"
#include "core/base/printable.h"

namespace hyades::cli {
namespace {

struct Options {
  std::string job;
  std::vector<std::string> films;
  std::string folder = ".";
  SceneOptions scene;
  FilmSizeOption size;   ///< as the films were rendered with
  uint32_t samples = 0;  ///< of the films, where not the job's; 0: the job's
  bool film = false;
  bool overwrite = false;
  bool quiet = false;
};

std::optional<int> parse(int argc, char** argv, Options& options) {
  CLI::App app(
      "Writes a job's pictures out of films, whole or in parts, that others have rendered.",
      "hyades finish");
  app.add_option("job", options.job, "the job, as it was rendered")->required();
  app.add_option("films", options.films, "film EXRs of its frames, in any order")->required();
  declare_class_option(app, options.scene);
  declare_scene_options(app, options.scene);
  declare_output_folder(app, options.folder);
  declare_film_size(app, options.size);
  app.add_option("--samples", options.samples,
                 "samples per pixel that the films were rendered with (default: the job's)")
      ->check(in_range(1U, 1U << 24U));
  app.add_flag("--film", options.film, "also write each frame's whole film (NAME.film.exr)");
  app.add_flag("--overwrite", options.overwrite,
               "replace files that are there, whoever made them (default: those of this job)");
  app.add_flag("-q,--quiet", options.quiet, "say nothing where all goes well");
  app.footer(
      "examples:\n"
      "  hyades render job.yaml --frames 7 --tile 1/3 --film 1.exr\n"
      "  hyades finish job.yaml 1.exr 2.exr 3.exr --output out\n"
      "Three machines render a third of a frame each, one finishes it.\n"
      "What is written is what 'hyades render' writes, byte for byte. Videos are made when all "
      "frames are there.\n"
      "exit status: 0 done, 1 something is missing or failed, 2 the job, the arguments or a film "
      "are wrong, 130 interrupted");
  return parse_command_line(app, argc, argv, kBadInput);
}

int fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  return kBadInput;
}

/// An error where a film is not of the job as it stands here: what a person would see at once goes
/// before all else.
core::Status check_film(const core::FilmInfo& info, const core::Job& job, const JobFrames& frames) {
  const std::string frame = fmt::format("frame {}", info.frame);
  if (info.width != job.film.width || info.height != job.film.height) {
    return core::Error{fmt::format(
        "{}: its films are of {} x {} pixels, the job's frames have {} x {}; --size {}x{} "
        "takes them all the same",
        frame, info.width, info.height, job.film.width, job.film.height, info.width, info.height)};
  }
  if (info.crop != core::render_window(job.film)) {
    return core::Error{
        frame + ": its films are of another part of the frame (--crop) than the job renders"};
  }
  if (info.samples != job.sampling.samples) {
    return core::Error{
        fmt::format("{}: its films are of {} samples per pixel, the job has {}; --samples {} takes "
                    "them all the same",
                    frame, info.samples, job.sampling.samples, info.samples)};
  }
  return frames.check_picture(info);
}

/// Joins the films of one frame and writes what is made of it.
int finish_frame(const Options& options, const std::vector<std::string>& films,
                 const core::Job& job, JobFrames& frames) {
  const auto whole =
      join_films(films, [&](const core::FilmInfo& info) { return check_film(info, job, frames); });
  if (!whole) return fail(whole.error().message);
  const int32_t frame = whole->info.frame;
  if (const std::string missing = what_is_missing(*whole); !missing.empty()) {
    std::fprintf(stderr, "frame %d: %s are there; missing: %s\n", frame, share_held(*whole).c_str(),
                 missing.c_str());
    return 1;
  }
  if (const auto written = frames.write_outputs_of(*whole); !written) {
    return fail(written.error().message);
  }
  if (options.quiet) return 0;
  for (const std::string& path : frames.output_paths(frame, false)) {
    std::fprintf(stderr, "wrote %s\n", path.c_str());
  }
  return 0;
}

}  // namespace

int finish_job_command(int argc, char** argv) {
  Options options;
  if (const auto status = parse(argc, argv, options)) return *status;
  auto loaded = load_job(options.job, options.scene);
  if (!loaded) return kBadInput;
  core::Job& job = loaded->job;
  resize_film(options.size, job.film);
  if (options.samples != 0) job.sampling.samples = options.samples;

  std::map<int32_t, std::vector<std::string>> films;
  for (const std::string& path : options.films) {
    const auto info = core::read_film_info(path);
    if (!info) return fail(info.error().message);
    if (info->job_name != job.name) {
      return fail(fmt::format("{}: a film of the job '{}', expected films of '{}'", path,
                              core::printable(info->job_name), job.name));
    }
    if (info->frame < job.frames.first || info->frame > job.frames.last) {
      return fail(fmt::format("{}: a film of frame {} of '{}', expected one of {} to {} of '{}'",
                              path, info->frame, core::printable(info->job_name), job.frames.first,
                              job.frames.last, job.name));
    }
    films[info->frame].push_back(path);
  }
  JobFrames frames(*loaded, {options.folder, options.film || job.keep_films, "", false,
                             core::render_window(job.film), false});
  if (const auto names = frames.check_film_names(); !names) return fail(names.error().message);
  if (const auto display = frames.load_display(); !display) return fail(display.error().message);
  std::vector<int32_t> numbers;
  for (const auto& [frame, paths] : films) numbers.push_back(frame);
  if (const auto may = frames.check_outputs(numbers, options.overwrite); !may) {
    return fail(may.error().message);
  }

  watch_for_interrupts();
  const core::FpMode mode;
  int worst = 0;
  for (const auto& [frame, paths] : films) {
    if (interrupted()) return kInterrupted;
    worst = std::max(worst, finish_frame(options, paths, job, frames));
  }
  if (worst != 0 || job.videos.empty()) return worst;
  if (!core::are_all_frames(job, numbers)) {
    if (!options.quiet) note_no_videos(job, options.folder, options.job);
    return 0;
  }
  if (!make_videos(job, options.folder, numbers, options.quiet)) {
    return interrupted() ? kInterrupted : 1;
  }
  for (const core::VideoDesc& video : job.videos) {
    core::remove_video_pictures(video, core::video_frames(job, options.folder, numbers));
  }
  return 0;
}

}  // namespace hyades::cli
