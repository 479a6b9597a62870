#pragma once

#include <cstdint>
#include <string>
#include <tuple>

#include "cli/status_line.h"
#include "coordinator/local/progress.h"

namespace hyades::cli {

/// "37 %" of the samples, rounded down.
std::string percent_done(const coordinator::Progress& progress);

/// How far a run of that name is, in a line; `bar`: drawn too.
std::string progress_line(const std::string& name, const coordinator::Progress& progress, bool bar);

/// Shows how far a run is: one line that is redrawn on a terminal, plain lines now and then
/// elsewhere, nothing where `quiet`. Writes to standard error.
class ProgressDisplay {
 public:
  ProgressDisplay(std::string name, bool quiet);

  /// Shows `progress` if it is time to.
  void update(const coordinator::Progress& progress);

  /// Removes the redrawn line, so that other text can be written.
  void clear();

 private:
  std::string name_;
  bool quiet_;
  StatusLine status_;
  /// Percent, frames that are done, and whether some are being finished.
  using Far = std::tuple<int, uint32_t, bool>;
  Far told_far_{-1, 0, false};
  std::string told_;  ///< the last trouble that was printed
};

}  // namespace hyades::cli
