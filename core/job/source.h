#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace hyades::core {

/// Where something stands in a job's text.
struct SourceLocation {
  std::string file;
  int line = 0;    ///< from 1; 0 = unknown
  int column = 0;  ///< from 1; 0 = unknown
};

/// One complaint: "file:line:column: what, and what was expected"; of scripts without the column.
struct Diagnostic {
  SourceLocation where;
  std::string message;
  std::string to_string() const;
};

/// Collects every complaint of a run, so that a person sees all of them at once. Stops collecting
/// (and says so) after 100.
class Diagnostics {
 public:
  /// Of scenes of other tools, which a job reads as documents made of them, only the file is told;
  /// of scripts the line too.
  void add(const SourceLocation& place, std::string message);
  bool empty() const { return list_.empty(); }
  bool full() const;  ///< further complaints would be dropped
  const std::vector<Diagnostic>& list() const { return list_; }
  std::string to_string() const;  ///< one per line, in order of file and line
  Error to_error() const;         ///< all of them as one error, whose last line has no end

 private:
  std::vector<Diagnostic> list_;
};

}  // namespace hyades::core
