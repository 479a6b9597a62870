#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/job_frames.h"
#include "cli/render_options.h"
#include "core/base/result.h"

namespace hyades::cli {

/// How many samples per pixel a render can take until its --time is over. They are chosen once,
/// before anything is rendered, by what samples of some frames cost: what is rendered is the
/// picture of that many samples, as --samples renders it on any machine.
class TimeLimit {
 public:
  /// `file` remembers what is chosen, for the same command to go on after it was interrupted.
  TimeLimit(const RenderOptions& options, std::string file,
            std::chrono::steady_clock::time_point began);

  /// What an interrupted run of the same command chose; else the samples that all frames `numbers`
  /// can have in what is left of the time, at least 1. Reads scenes of some frames; the error is
  /// theirs.
  core::Result<uint32_t> samples(JobFrames& frames, const std::vector<int32_t>& numbers);

  /// Remembers what was chosen. Where that fails the same command begins again.
  void write() const;

 private:
  std::string command() const;
  uint32_t chosen_before() const;
  core::Result<uint32_t> choose(JobFrames& frames, const std::vector<int32_t>& numbers) const;

  const RenderOptions& options_;
  const std::string file_;
  const std::chrono::steady_clock::time_point began_;
  uint32_t samples_ = 0;  ///< 0: there is no --time
};

}  // namespace hyades::cli
