#pragma once

#include <string>

#include "cli/load_job.h"

namespace hyades::cli {

/// Remembers how outputs were made, so that a resumed run does not take pictures for finished that
/// were made with another exposure, say.
class OutputNote {
 public:
  /// For the file `path`.
  OutputNote(std::string path, const LoadedJob& loaded);

  /// Whether an earlier run noted the same settings.
  bool still_true() const;

  /// Without the note a later run only makes the outputs again, so failing to write it is no error.
  void write() const;

 private:
  std::string path_;
  std::string digest_;
};

}  // namespace hyades::cli
