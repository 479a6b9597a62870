#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/job/video.h"

namespace hyades::coordinator {

/// What somebody wants a video to be.
struct VideoRequest {
  std::string file;  ///< .mp4, .mov or .webm below the outputs; empty: NAME.mp4 by the job's name
  std::string pictures;  ///< as an entry of the job's outputs has it; empty: the first that will do
  double rate = 0;       ///< frames per second; 0: as the job has it
};

/// A video that was asked for.
struct RequestedVideo {
  enum class State : uint8_t { waiting, making, done, failed };
  uint64_t number = 0;  ///< by which it is told from others; given by VideoMaker
  uint64_t job = 0;     ///< whose frames it shows
  std::string owner{};  ///< of the job
  core::VideoDesc video;
  core::VideoFrames frames;
  State state = State::waiting;
  std::string reason;  ///< why it failed
};

/// The video that `request` means, of a job whose finished frames (`frames`: their numbers) have
/// left `files`. An error where there is nothing to make it of, or the request makes no sense.
core::Result<RequestedVideo> plan_video(const core::Job& job, const VideoRequest& request,
                                        std::vector<int32_t> frames,
                                        const std::vector<std::string>& files);

}  // namespace hyades::coordinator
