#pragma once

#include <memory>
#include <string>
#include <utility>

#include "core/base/result.h"

namespace hyades::cli {

/// Whether a file's name is that of a scene of Blender: .blend.
bool is_blend_file(const std::string& path);

/// The job that Blender makes of a .blend with Hyades' add-on, in a temporary folder that goes with
/// this object.
class BlendJob {
 public:
  /// Opens `path` in Blender: the program that the environment variable HYADES_BLENDER names, else
  /// `blender` on PATH. `frames`: 7, 1-10 or 1-10x2; empty: all, or one where nothing moves. Prints
  /// what was not exported to standard error. Errors: no such file, no Blender, no add-on, what the
  /// add-on refuses.
  static core::Result<std::unique_ptr<BlendJob>> make(const std::string& path,
                                                      const std::string& frames);
  ~BlendJob();
  BlendJob(const BlendJob&) = delete;
  BlendJob& operator=(const BlendJob&) = delete;

  /// The file of the job.
  std::string path() const { return folder_ + "/job.yaml"; }

 private:
  explicit BlendJob(std::string folder) : folder_(std::move(folder)) {}

  std::string folder_;
};

}  // namespace hyades::cli
