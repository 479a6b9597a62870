// `hyades video job.yaml`.
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/frame_range.h"
#include "cli/interrupt.h"
#include "cli/load_job.h"
#include "cli/own_files.h"
#include "cli/scene_options.h"
#include "cli/videos.h"
#include "cli/written_file.h"
#include "core/job/output_path.h"

namespace hyades::cli {

namespace {

/// Whether a video of some frames would be called as something else that the job writes; says so.
bool takes_anothers_place(const core::Job& job, const std::string& folder,
                          const std::vector<int32_t>& numbers) {
  const core::VideoFrames frames = core::video_frames(job, folder, numbers);
  if (frames.part.empty()) return false;
  for (const core::VideoDesc& video : job.videos) {
    const std::string file = core::video_file(video, frames);
    for (const core::VideoDesc& other : job.videos) {
      if (!core::same_output_path(other.file, file)) continue;
      std::fprintf(stderr, "%s: these frames of '%s' would go to '%s', which line %d writes\n",
                   job.file.c_str(), video.file.c_str(), file.c_str(), other.where.line);
      return true;
    }
  }
  return false;
}

}  // namespace

int video_command(int argc, char** argv) {
  std::string path;
  SceneOptions scene;
  std::string range;
  std::string folder = ".";
  bool quiet = false;
  bool overwrite = false;
  CLI::App app("Makes a job's videos of the pictures that its frames have left.", "hyades video");
  app.add_option("job", path, "the job (.yaml)")->required();
  declare_scene_options(app, scene);
  app.add_option("--frames", range, "only of these frames: 1-10 or 1-10x2 (default: all)")
      ->check(no_frames_error);
  declare_output_folder(app, folder, "folder of the render's outputs");
  app.add_flag("--overwrite", overwrite,
               "replace files that are there, whoever made them (default: those of this job)");
  app.add_flag("-q,--quiet", quiet, "say nothing but what is wrong");
  app.footer(
      "examples:\n"
      "  hyades video jobs/perlin-sphere/job.yaml --output out\n"
      "For after a render that could not make them (ffmpeg was not there), and for some of a job's "
      "frames.\n"
      "The pictures go when videos of all frames are made, and stay otherwise.\n"
      "exit status: 0 done, 1 something failed, 2 the job or the arguments are wrong, 130 "
      "interrupted");
  if (const auto status = parse_command_line(app, argc, argv, kBadInput)) return *status;
  const auto loaded = load_job(path, scene);
  if (!loaded) return kBadInput;
  const core::Job& job = loaded->job;
  if (job.videos.empty()) {
    std::fprintf(stderr, "%s: none of its outputs is a video (.mp4, .mov, .webm)\n", path.c_str());
    return kBadInput;
  }
  const auto numbers = select_frames(job, range);
  if (!numbers) return kBadInput;
  if (takes_anothers_place(job, folder, *numbers)) return kBadInput;
  if (!overwrite) {
    std::vector<std::string> files;
    const core::VideoFrames frames = core::video_frames(job, folder, *numbers);
    for (const core::VideoDesc& video : job.videos) {
      files.push_back(folder + "/" + core::video_file(video, frames));
    }
    if (const auto may = check_own_files(files, job.name); !may) {
      print_error(may.error());
      return kBadInput;
    }
  }
  watch_for_interrupts();
  if (!make_videos(job, folder, *numbers, quiet)) return interrupted() ? kInterrupted : 1;
  if (core::are_all_frames(job, *numbers)) {
    const core::VideoFrames frames = core::video_frames(job, folder, *numbers);
    for (const core::VideoDesc& video : job.videos) core::remove_video_pictures(video, frames);
  }
  return 0;
}

}  // namespace hyades::cli
