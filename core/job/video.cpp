#include "core/job/video.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/job/output_path.h"

namespace hyades::core {
namespace {

/// As --frames takes it: 7, 1-10 or 1-10x2.
std::string range_in_words(const std::vector<int32_t>& numbers, int32_t step) {
  if (numbers.size() < 2) return numbers.empty() ? "" : std::to_string(numbers[0]);
  return fmt::format("{}-{}{}", numbers.front(), numbers.back(),
                     step > 1 ? fmt::format("x{}", step) : "");
}

}  // namespace

VideoFrames video_frames(const Job& job, std::string folder, std::vector<int32_t> numbers) {
  VideoFrames frames;
  frames.folder = std::move(folder);
  frames.numbers = std::move(numbers);
  std::sort(frames.numbers.begin(), frames.numbers.end());
  const int32_t step = frames.numbers.size() > 1 ? frames.numbers[1] - frames.numbers[0] : 1;
  frames.rate = double{job.frames.fps} / step;
  if (!are_all_frames(job, frames.numbers)) frames.part = range_in_words(frames.numbers, step);
  return frames;
}

std::vector<std::string> video_pictures(const VideoDesc& video, const VideoFrames& frames) {
  std::vector<std::string> paths;
  for (const int32_t number : frames.numbers) {
    paths.push_back(
        (std::filesystem::path(frames.folder) / output_path(video.pictures, number)).string());
  }
  return paths;
}

const OutputDesc* own_pictures(const Job& job, const VideoDesc& video) {
  const auto own =
      std::find_if(job.outputs.begin(), job.outputs.end(),
                   [&](const OutputDesc& output) { return output.file == video.pictures; });
  return own != job.outputs.end() ? &*own : nullptr;
}

std::vector<std::string> alike_pictures(const Job& job, const VideoDesc& video) {
  const OutputDesc* own = own_pictures(job, video);
  std::vector<std::string> lossless = {video.pictures};
  std::vector<std::string> lossy;
  for (const OutputDesc& output : job.outputs) {
    const std::string ending = file_extension(output.file);
    if (own == nullptr || &output == own || ending == ".exr" || output.transparent ||
        output.layers != own->layers || output.tone_map != own->tone_map ||
        output.exposure != own->exposure || output.denoise != own->denoise) {
      continue;
    }
    (ending == ".jpg" || ending == ".jpeg" ? lossy : lossless).push_back(output.file);
  }
  lossless.insert(lossless.end(), lossy.begin(), lossy.end());
  return lossless;
}

const OutputDesc* light_of_pictures(const Job& job, const VideoDesc& video) {
  const OutputDesc* own = own_pictures(job, video);
  // An EXR has a denoised picture as a layer of its own.
  if (own == nullptr || own->denoise != "false" || job.color) return nullptr;
  const std::string layer = own->layers.empty() ? "beauty" : own->layers.front();
  for (const OutputDesc& output : job.outputs) {
    if (file_extension(output.file) != ".exr") continue;
    const bool is_beauty = output.layers.empty() && layer == "beauty";
    const auto& layers = output.layers;
    if (is_beauty || std::find(layers.begin(), layers.end(), layer) != layers.end()) return &output;
  }
  return nullptr;
}

bool are_all_frames(const Job& job, const std::vector<int32_t>& numbers) {
  const int64_t all = (int64_t{job.frames.last} - job.frames.first) / job.frames.step + 1;
  return static_cast<int64_t>(numbers.size()) == all &&
         std::all_of(numbers.begin(), numbers.end(), [&](int32_t number) {
           return (int64_t{number} - job.frames.first) % job.frames.step == 0;
         });
}

std::string video_file(const VideoDesc& video, const VideoFrames& frames) {
  if (frames.part.empty()) return video.file;
  std::filesystem::path path(video.file);
  const std::string extension = path.extension().string();
  path.replace_extension(frames.part + extension);
  return path.string();
}

std::string video_folder(const VideoDesc& video) {
  return std::filesystem::path(video.pictures).parent_path().string();
}

}  // namespace hyades::core
