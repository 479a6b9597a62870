#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/blend_job.h"
#include "cli/own_files.h"
#include "cli/scene_options.h"
#include "core/base/assets.h"
#include "core/base/result.h"
#include "core/job/job.h"

namespace hyades::cli {

/// A job that has been read and found good, and the door to its files.
struct LoadedJob {
  std::unique_ptr<BlendJob> blend;  ///< where the job was made of a .blend: has its files
  core::Job job;
  std::unique_ptr<core::JobFiles> files;
  std::unique_ptr<core::RecordingResolver> assets;  ///< over `files`; knows what was opened
};

/// Reads `path`: a job, a .blend, or a scene or mesh of another tool, which gets a camera, ground
/// and sky that suit it where it has none. Prints what importers left out, and every complaint, to
/// standard error and returns nothing where there is a complaint.
std::optional<LoadedJob> load_job(const std::string& path, const SceneOptions& scene = {});

/// Reads `path` as load_job does, but prints no complaint about the job: they go to `diagnostics`,
/// and what could be read is returned. Nothing (and a message) where there is no such file or the
/// scene is broken.
std::optional<LoadedJob> read_job_file(const std::string& path, core::Diagnostics& diagnostics,
                                       const SceneOptions& scene = {});

/// Exit status of a command whose arguments or job were wrong.
inline constexpr int kBadInput = 2;

/// So many frames are rendered in one run: each takes some memory.
inline constexpr int64_t kMostFrames = 1'000'000;

/// The frames of "7", "1-10" or "1-10x2" that the job has; nothing (and a message) where the text
/// is not of that form, names a frame outside the job, or the frames are more than kMostFrames.
std::optional<std::vector<int32_t>> select_frames(const core::Job& job, const std::string& text);

/// Whether --frame `frame` is within the job's range; a message where it is not.
bool is_in_range(const core::Job& job, int32_t frame);

}  // namespace hyades::cli
