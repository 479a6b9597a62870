#include "coordinator/controller/requested_video.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/job/output_path.h"

namespace hyades::coordinator {
namespace {

constexpr double kFastest = 240;  // frames per second

/// The job's name as a file's: letters, digits, '-' and '_' only.
std::string file_named_after(const std::string& name) {
  std::string file;
  for (const char c : name) {
    file += core::is_letter_or_digit(c) || c == '_' ? c : '-';
  }
  return (file.empty() ? "video" : file) + ".mp4";
}

/// With # for each number, so that the files of all frames are alike.
std::string without_numbers(const std::string& file) {
  std::string alike;
  for (const char c : file) {
    const bool digit = c == '#' || (c >= '0' && c <= '9');
    if (!digit) {
      alike += c;
    } else if (!alike.ends_with('#')) {
      alike += '#';
    }
  }
  return alike;
}

/// Whether the video may be called so, beside all else that the job writes.
core::Status check_file(const core::Job& job, const std::string& file) {
  const std::string extension = core::file_extension(file);
  if ((extension != ".mp4" && extension != ".mov" && extension != ".webm") ||
      core::output_name(file) != core::OutputName::plain || file.find('#') != std::string::npos ||
      std::any_of(file.begin(), file.end(), [](unsigned char c) { return c < ' '; })) {
    return core::Error{"file '" + file +
                       "': expected the name of a .mp4, .mov or .webm below the job's outputs"};
  }
  const auto takes_place_of = [&](const std::string& other) {
    return core::same_output_path(other, file) ||
           core::nested_output_paths(without_numbers(other), without_numbers(file));
  };
  for (const core::OutputDesc& output : job.outputs) {
    if (takes_place_of(output.file)) {
      return core::Error{"file '" + file + "': the job writes '" + output.file + "' itself"};
    }
  }
  for (const core::VideoDesc& video : job.videos) {
    if (takes_place_of(video.file)) {
      return core::Error{"file '" + file + "': the job makes that video itself"};
    }
  }
  return {};
}

}  // namespace

core::Result<RequestedVideo> plan_video(const core::Job& job, const VideoRequest& request,
                                        std::vector<int32_t> frames,
                                        const std::vector<std::string>& files) {
  RequestedVideo asked;
  asked.video.file = request.file.empty() ? file_named_after(job.name) : request.file;
  if (core::Status right = check_file(job, asked.video.file); !right) return right.error();
  asked.video.file = std::filesystem::path(asked.video.file).lexically_normal().string();
  if (request.rate != 0 && !(request.rate > 0 && request.rate <= kFastest)) {
    return core::Error{
        fmt::format("rate: expected more than 0 and at most {} frames per second", kFastest)};
  }
  const std::set<std::string> there(files.begin(), files.end());
  bool known = request.pictures.empty();
  std::vector<int32_t> shown;
  for (const core::OutputDesc& output : job.outputs) {
    if (!request.pictures.empty() && output.file != request.pictures) continue;
    known = true;
    if (core::file_extension(output.file) == ".exr") continue;  // for no display
    shown.clear();
    for (const int32_t frame : frames) {
      if (there.contains(core::output_path(output.file, frame))) shown.push_back(frame);
    }
    asked.video.pictures = output.file;
    if (!shown.empty()) break;
  }
  if (!known) {
    return core::Error{"pictures: the job writes no '" + request.pictures + "'"};
  }
  if (asked.video.pictures.empty()) {
    return core::Error{"the job writes no pictures that a video can be made of: PNG, JPEG or TIFF"};
  }
  if (shown.empty()) return core::Error{"no picture of a frame is finished yet"};
  asked.frames = core::video_frames(job, {}, std::move(shown));
  asked.frames.part.clear();
  if (request.rate > 0) asked.frames.rate = request.rate;
  return asked;
}

}  // namespace hyades::coordinator
