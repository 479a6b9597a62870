#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/assets.h"
#include "core/base/result.h"
#include "core/job/job.h"

namespace hyades::cli {

/// A job that has been read and found good, and the door to its files.
struct LoadedJob {
  core::Job job;
  std::unique_ptr<core::AssetResolver> files;
  std::unique_ptr<core::RecordingResolver> assets;  ///< over `files`; knows what was opened
};

/// Reads `path`: a job, or a mesh (.obj, .ply), which gets a camera, ground and sky that suit it;
/// `media` is then a file of media for its materials, or empty. Prints every complaint to standard
/// error and returns nothing where there is one.
std::optional<LoadedJob> load_job(const std::string& path, const std::string& media = {});

/// The same without printing complaints about the job: they go to `diagnostics`, and what could be
/// read is returned. Nothing (and a message) where there is no such file or the mesh is broken.
std::optional<LoadedJob> read_job_file(const std::string& path, core::Diagnostics& diagnostics,
                                       const std::string& media = {});

/// The text of the job that a mesh is rendered as, whose files are relative to `folder`.
core::Result<std::string> text_of_mesh_job(const std::string& mesh, const std::string& media,
                                           const std::string& folder);

/// Whether a path is a mesh's by its name.
bool is_mesh(const std::string& path);

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
