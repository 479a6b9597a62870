#include "core/job/mesh_files.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <system_error>

#include "core/job/layers.h"
#include "core/job/output_path.h"

namespace hyades::core {

bool is_mesh_sequence(const std::string& file) { return file.find('#') != std::string::npos; }

std::string mesh_file_at(const std::string& file, const JobTime& time) {
  return is_mesh_sequence(file) ? output_path(file, static_cast<int32_t>(std::floor(time.frame)))
                                : file;
}

bool is_of_sequence(const std::string& pattern, const std::string& file) {
  const size_t run = pattern.find('#');
  if (run == std::string::npos || run >= file.size()) return file == pattern;
  if (file.compare(0, run, pattern, 0, run) != 0) return false;
  int32_t frame = 0;
  const auto number = std::from_chars(file.data() + run, file.data() + file.size(), frame);
  return number.ec == std::errc() && output_path(pattern, frame) == file;
}

bool looks_at_next_frame(const Job& job) {
  return job.frames.shutter > 0.0F || needed_layers(job).motion;
}

Status open_mesh_sequence(const Job& job, const std::string& pattern, AssetResolver& assets) {
  const bool ahead = looks_at_next_frame(job);
  for (int64_t at = job.frames.first; at <= job.frames.last; at += job.frames.step) {
    const auto frame = static_cast<int32_t>(at);
    if (const auto bytes = assets.open(output_path(pattern, frame)); !bytes) {
      return bytes.error().in("frame " + std::to_string(frame));
    }
    if (!ahead || frame == std::numeric_limits<int32_t>::max()) continue;
    const std::string next = output_path(pattern, frame + 1);
    if (!assets.exists(next)) continue;
    if (const auto bytes = assets.open(next); !bytes) {
      return bytes.error().in("frame " + std::to_string(frame + 1));
    }
  }
  return {};
}

}  // namespace hyades::core
