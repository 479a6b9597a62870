#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/job/job.h"

namespace hyades::cli {

/// Frames first, first + step, ... up to last.
struct FrameRange {
  int first = 1;
  int last = 1;
  int step = 1;
};

/// How many frames first, first + step, ... up to last are.
inline int64_t frame_count(int first, int last, int step) {
  return (int64_t{last} - first) / step + 1;
}

/// "7", "1-10" or "1-10x2" as frames of a job; "" is all of them. An error where the text is not of
/// that form or names a frame outside the job's range.
core::Result<FrameRange> parse_frames(const core::FramesDesc& job, const std::string& text);

/// "7,8,20-30x2": frames and ranges with commas between them. An error where the text is not of
/// that form.
core::Result<std::vector<FrameRange>> parse_frame_list(const std::string& text);

/// What is wrong with such a text; empty: nothing. For options of CLI11.
std::string frame_list_error(const std::string& text);

/// What is wrong with the text of --frames whatever the job: it says nothing. For options of CLI11.
std::string no_frames_error(const std::string& text);

}  // namespace hyades::cli
