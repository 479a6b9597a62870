#pragma once

#include <string>

#include "cli/status_line.h"
#include "coordinator/local/progress.h"

namespace hyades::cli {

/// "37 %" of the samples, rounded down.
std::string percent_done(const coordinator::Progress& progress);

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
  std::string line(const coordinator::Progress& progress) const;

  std::string name_;
  bool quiet_;
  StatusLine status_;
  int last_percent_ = -1;
  std::string told_;  ///< the last trouble that was printed
};

}  // namespace hyades::cli
