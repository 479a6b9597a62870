#include "cli/videos.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "cli/command_line.h"
#include "cli/interrupt.h"
#include "core/base/text.h"

namespace hyades::cli {
namespace {

/// `video` with pictures that are there, where its own are not: those of a job that was rendered
/// whole are gone.
core::VideoDesc with_pictures_at_hand(const core::Job& job, const core::VideoDesc& video,
                                      const core::VideoFrames& frames) {
  core::VideoDesc found = video;
  for (const std::string& pictures : core::alike_pictures(job, video)) {
    found.pictures = pictures;
    if (core::missing_pictures(found, frames).empty()) return found;
  }
  return video;
}

}  // namespace

bool make_videos(const core::Job& job, const std::string& folder,
                 const std::vector<int32_t>& numbers, bool quiet) {
  const core::VideoFrames frames = core::video_frames(job, folder, numbers);
  bool all = true;
  for (const core::VideoDesc& video : job.videos) {
    const std::string file = core::video_file(video, frames);
    const core::VideoDesc at_hand = with_pictures_at_hand(job, video, frames);
    std::error_code none;
    if (!core::missing_pictures(at_hand, frames).empty() &&
        std::filesystem::exists(std::filesystem::path(folder) / file, none)) {
      std::fprintf(stderr,
                   "%s/%s is there, and its pictures are gone since: 'hyades render' with "
                   "--restart makes it anew\n",
                   folder.c_str(), file.c_str());
      all = false;
      continue;
    }
    if (!quiet) {
      std::fprintf(stderr, "making %s/%s of %s\n", folder.c_str(), file.c_str(),
                   core::counted(frames.numbers.size(), "frame").c_str());
    }
    core::VideoPatience patience;
    patience.stop = interrupted;
    if (!quiet && at_hand.pictures != video.pictures) {
      std::fprintf(stderr, "of %s, which look the same as its own pictures\n",
                   at_hand.pictures.c_str());
    }
    if (const auto made = core::make_video(at_hand, frames, patience); !made) {
      print_error(made.error());
      all = false;
    } else if (!quiet) {
      std::fprintf(stderr, "wrote %s/%s\n", folder.c_str(), file.c_str());
    }
    if (interrupted()) return false;
  }
  return all;
}

void note_no_videos(const core::Job& job, const std::string& folder, const std::string& path) {
  for (const core::VideoDesc& video : job.videos) {
    std::fprintf(stderr,
                 "%s/%s is not made: these are not all of the job's frames. Their pictures are in "
                 "%s.frames; 'hyades video %s --output %s' makes it when all are there, with "
                 "--frames a part of it\n",
                 folder.c_str(), video.file.c_str(), video.file.c_str(), path.c_str(),
                 folder.c_str());
  }
}

}  // namespace hyades::cli
