#include "cli/frame_range.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>

namespace hyades::cli {

std::string no_frames_error(const std::string& text) {
  if (!text.empty()) return {};
  return "expected frames such as 7, 1-10 or 1-10x2";
}

namespace {

constexpr std::string_view kOption = "--frames ";

/// Of the form alone.
core::Result<FrameRange> read_range(const std::string& text) {
  FrameRange range;
  int used = 0;
  const auto whole = [&] { return used == static_cast<int>(text.size()); };
  if (std::sscanf(text.c_str(), "%d-%dx%d%n", &range.first, &range.last, &range.step, &used) < 3 ||
      !whole()) {
    range.step = 1;
    if (std::sscanf(text.c_str(), "%d-%d%n", &range.first, &range.last, &used) < 2 || !whole()) {
      if (std::sscanf(text.c_str(), "%d%n", &range.first, &used) < 1 || !whole()) {
        return core::Error{fmt::format(
            "{}{}: expected a frame (7), a range (1-10) or a range with a step (1-10x2)", kOption,
            text)};
      }
      range.last = range.first;
    }
  }
  if (range.step < 1 || range.first > range.last) {
    return core::Error{fmt::format(
        "{}{}: expected a range from its first frame on, such as 1-10 or 1-10x2", kOption, text)};
  }
  return range;
}

}  // namespace

core::Result<std::vector<FrameRange>> parse_frame_list(const std::string& text) {
  std::vector<FrameRange> ranges;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const std::string one = text.substr(begin, end - begin);
    const auto range = read_range(one.empty() ? text : one);  // what is wrong is seen in the whole
    if (!range) return range.error();
    ranges.push_back(*range);
    begin = end + 1;
  }
  return ranges;
}

std::string frame_list_error(const std::string& text) {
  const auto ranges = parse_frame_list(text);
  if (ranges) return {};
  // CLI11 says which option it is.
  const std::string& message = ranges.error().message;
  return message.starts_with(kOption) ? message.substr(kOption.size()) : message;
}

core::Result<FrameRange> parse_frames(const core::FramesDesc& job, const std::string& text) {
  if (text.empty()) return FrameRange{job.first, job.last, job.step};
  const auto read = read_range(text);
  if (!read) return read.error();
  const FrameRange range = *read;
  if (range.first < job.first || range.last > job.last) {
    return core::Error{fmt::format("{}{}: expected frames within the job's range {}-{}", kOption,
                                   text, job.first, job.last)};
  }
  return range;
}

}  // namespace hyades::cli
