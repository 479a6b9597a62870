#include "core/job/frame_files.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/base/text.h"
#include "core/job/layers.h"
#include "core/job/output_path.h"

namespace hyades::core {
namespace {

/// Ten times the files that a job may have on a farm. Patterns are short, so that very many could
/// mean the same files.
constexpr uint64_t kMostSequenceFiles = 1'000'000;

}  // namespace

bool is_file_sequence(const std::string& file) { return file.find('#') != std::string::npos; }

std::string frame_file_at(const std::string& file, const JobTime& time) {
  return is_file_sequence(file) ? output_path(file, static_cast<int32_t>(std::floor(time.frame)))
                                : file;
}

bool looks_at_next_frame(const Job& job) {
  return job.frames.shutter > 0.0F || needed_layers(job).motion;
}

std::set<std::string> sequence_files(const Job& job, const std::set<std::string>& patterns) {
  const bool ahead = looks_at_next_frame(job);
  std::set<std::string> files;
  for (const std::string& pattern : patterns) {
    for (int64_t at = job.frames.first; at <= job.frames.last; at += job.frames.step) {
      if (files.size() > kMostSequenceFiles) return files;
      const auto frame = static_cast<int32_t>(at);
      files.insert(output_path(pattern, frame));
      if (!ahead || frame == std::numeric_limits<int32_t>::max()) continue;
      files.insert(output_path(pattern, frame + 1));
    }
  }
  return files;
}

FileSequenceOpener::FileSequenceOpener(const Job& job, AssetResolver& assets)
    : frames_(job.frames), assets_(assets), ahead_(looks_at_next_frame(job)) {}

Status FileSequenceOpener::open(const std::string& pattern, FrameFiles files) {
  const bool ahead = ahead_ && files == FrameFiles::own_and_next;
  for (int64_t at = frames_.first; at <= frames_.last; at += frames_.step) {
    if (++looked_for_ > kMostSequenceFiles) {
      return Error{"the job's sequences of files have more than " +
                   format_count(kMostSequenceFiles) + " files"};
    }
    const auto frame = static_cast<int32_t>(at);
    if (auto opened = open_at(frame, output_path(pattern, frame)); !opened) return opened;
    if (!ahead || frame == std::numeric_limits<int32_t>::max()) continue;
    std::string next = output_path(pattern, frame + 1);
    if (opened_.contains(next) || !assets_.exists(next)) continue;
    if (auto opened = open_at(frame + 1, std::move(next)); !opened) return opened;
  }
  return {};
}

Status FileSequenceOpener::open_at(int32_t frame, std::string file) {
  if (opened_.contains(file)) return {};
  if (const auto bytes = assets_.open(file); !bytes) {
    return bytes.error().in("frame " + std::to_string(frame));
  }
  opened_.insert(std::move(file));
  return {};
}

}  // namespace hyades::core
