#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/job/job.h"

namespace hyades::core {

/// What a video is made of.
struct VideoFrames {
  std::string folder;            ///< below which the video and the frames' pictures are
  std::vector<int32_t> numbers;  ///< in order
  std::string part;              ///< "10-20" or "10-20x2" of some of the job's frames; empty: all
  double rate = 24;              ///< of them per second
};

/// What videos of the job are made of when these frames of it are there. Their motion keeps its
/// speed: where every second one is left out, `rate` is half the job's fps.
VideoFrames video_frames(const Job& job, std::string folder, std::vector<int32_t> numbers);

/// The output of the job that leaves the pictures of `video`; nullptr where there is none.
const OutputDesc* own_pictures(const Job& job, const VideoDesc& video);

/// The outputs of the job whose files look like the pictures of `video`, whose own come first: the
/// same layer, exposure and tone map, no alpha. The less is lost in them the sooner they come.
std::vector<std::string> alike_pictures(const Job& job, const VideoDesc& video);

/// The EXR output of the job that holds the light which the pictures of `video` show; nullptr where
/// none does: where they are denoised, or made by a colour configuration.
const OutputDesc* light_of_pictures(const Job& job, const VideoDesc& video);

/// Whether these frames are all of the job's, each once: only then are its videos made unasked.
bool are_all_frames(const Job& job, const std::vector<int32_t>& numbers);

/// The paths of the frames' pictures for `video`, with VideoFrames::folder before them.
std::vector<std::string> video_pictures(const VideoDesc& video, const VideoFrames& frames);

/// The video's path below VideoFrames::folder: `video.mp4`, or `video.10-20.mp4` of some frames,
/// which must not take the place of the whole video.
std::string video_file(const VideoDesc& video, const VideoFrames& frames);

/// The folder of a video's pictures, below the output folder.
std::string video_folder(const VideoDesc& video);

}  // namespace hyades::core
