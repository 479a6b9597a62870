#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/local/progress.h"

namespace hyades::cli {

/// Tells other programs how a run gets on: an object of JSON a line on standard output. Says
/// nothing where nobody has asked for it.
class JsonReport {
 public:
  explicit JsonReport(bool asked) : asked_(asked) {}

  /// `{"event": "progress", ...}`, five times a second at most.
  void progress(const coordinator::Progress& progress);

  /// `{"event": "written", "frame": 7, "files": [...]}`; without a frame of what all make together.
  void written(std::optional<int32_t> frame, const std::vector<std::string>& files) const;

 private:
  bool asked_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace hyades::cli
