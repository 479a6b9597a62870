#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/job/video.h"

namespace hyades::core {

/// What is said where there is no ffmpeg.
inline constexpr const char* kNoFfmpeg =
    "ffmpeg is not here (no such program in PATH): install it (apt install ffmpeg)";

/// Whether ffmpeg is in PATH.
bool have_ffmpeg();

/// How long making a video may take, and who may end it.
struct VideoPatience {
  /// A program and its arguments that start ffmpeg, whose path and arguments follow: for who holds
  /// it in. Empty: it is started itself.
  std::vector<std::string> starter;
  std::chrono::milliseconds still{120'000};  ///< ffmpeg may make no progress for so long
  std::function<bool()> stop;                ///< asked often; true ends it
};

/// Those of the frames' pictures for `video` that are missing.
std::vector<std::string> missing_pictures(const VideoDesc& video, const VideoFrames& frames);

/// Makes `video` of the frames' pictures by ffmpeg, which runs as a child: H.264 in .mp4 and .mov
/// (its index in front), VP9 in .webm, 4:2:0 of 8 bits. Colours are tagged as what they are:
/// Rec.709 primaries and matrix, studio range, transfer sRGB (or linear). Where a side is odd its
/// last row or column is there twice, as 4:2:0 needs even ones. What the first picture's header
/// says goes into the file's title and comment. The file is complete or absent. Errors name the
/// picture that is missing, damaged or of another rendering than the first, or say what ffmpeg
/// said.
Status make_video(const VideoDesc& video, const VideoFrames& frames,
                  const VideoPatience& patience = {});

/// Removes the frames' pictures, and their folder where nothing else is in it.
void remove_video_pictures(const VideoDesc& video, const VideoFrames& frames);

}  // namespace hyades::core
