#pragma once

#include <memory>
#include <string>
#include <utility>

#include "cli/temporary_folder.h"
#include "core/base/result.h"

namespace hyades::cli {

/// Whether a file's name is that of a scene of Blender: .blend.
bool is_blend_file(const std::string& path);

/// The job that Blender makes of a .blend with Hyades' add-on, in a temporary folder that goes with
/// this object, or with the process.
class BlendJob {
 public:
  /// Opens `path` in Blender: the program that the environment variable HYADES_BLENDER names, else
  /// `blender` on PATH. `frames`: 7, 1-10 or 1-10x2; empty: all, or one where nothing moves. Prints
  /// what was not exported to standard error. Errors: no such file, no Blender, no add-on, what the
  /// add-on refuses.
  static core::Result<std::unique_ptr<BlendJob>> make(const std::string& path,
                                                      const std::string& frames);

  /// The file of the job.
  std::string path() const { return folder_->path() + "/job.yaml"; }

 private:
  explicit BlendJob(std::unique_ptr<TemporaryFolder> folder) : folder_(std::move(folder)) {}

  std::unique_ptr<TemporaryFolder> folder_;
};

}  // namespace hyades::cli
