#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/job/video.h"

namespace hyades::coordinator {

/// What somebody wants of a video.
struct VideoWish {
  std::string file;  ///< .mp4, .mov or .webm below the outputs; empty: NAME.mp4 by the job's name
  std::string pictures;  ///< as an entry of the job's outputs has it; empty: the first that will do
  double rate = 0;       ///< frames per second; 0: as the job has it
};

/// A video that was asked for.
struct AskedVideo {
  enum class State : uint8_t { waiting, making, done, failed };
  uint64_t number = 0;
  uint64_t job = 0;
  core::VideoDesc video;
  core::VideoFrames frames;
  State state = State::waiting;
  std::string reason;  ///< why it failed
};

const char* name_of(AskedVideo::State state);

/// Of a job whose finished frames have left these files: what `wish` means. `frames` are the
/// numbers of the finished frames; an error where there is nothing to make it of.
core::Result<AskedVideo> plan_video(const core::Job& job, const VideoWish& wish,
                                    std::vector<int32_t> frames,
                                    const std::vector<std::string>& files);

}  // namespace hyades::coordinator
