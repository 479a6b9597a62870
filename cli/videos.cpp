#include "cli/videos.h"

#include <cstdio>

#include "cli/interrupt.h"

namespace hyades::cli {

bool make_videos(const core::Job& job, const std::string& folder,
                 const std::vector<int32_t>& numbers, bool quiet) {
  const core::VideoFrames frames = core::video_frames(job, folder, numbers);
  bool all = true;
  for (const core::VideoDesc& video : job.videos) {
    const std::string file = core::video_file(video, frames);
    if (!quiet) {
      std::fprintf(stderr, "making %s/%s of %zu frames\n", folder.c_str(), file.c_str(),
                   frames.numbers.size());
    }
    core::VideoPatience patience;
    patience.stop = interrupted;
    if (const auto made = core::make_video(video, frames, patience); !made) {
      std::fprintf(stderr, "%s\n", made.error().message.c_str());
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
