#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/job/job.h"

namespace hyades::cli {

/// A job that has been read and found good, and the door to its files.
struct LoadedJob {
  core::Job job;
  std::unique_ptr<core::AssetResolver> files;
  std::unique_ptr<core::RecordingResolver> assets;  ///< over `files`; knows what was opened
};

/// Reads `path`: a job, or a mesh (.obj, .ply), which gets a camera, ground and sky that suit it.
/// Prints every complaint to standard error and returns nothing where there is one.
std::optional<LoadedJob> load_job(const std::string& path);

/// Exit status of a command whose arguments or job were wrong.
inline constexpr int kBadInput = 2;

/// The frames of "7", "1-10" or "1-10x2" that the job has; nothing (and a message) where the text
/// is not of that form or names a frame outside the job.
std::optional<std::vector<int32_t>> select_frames(const core::Job& job, const std::string& text);

}  // namespace hyades::cli
