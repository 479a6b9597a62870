#pragma once

#include <set>
#include <string>

#include "cli/client/failure.h"

namespace hyades::cli {

/// Which files of a folder `hyades fetch` has written: the file `.hyades/fetched` in it has a line
/// for each. A coordinator names the files, so that without it one that is hostile could have
/// others of the folder replaced.
class FetchRecord {
 public:
  /// Of `folder`, which need not be there yet.
  explicit FetchRecord(std::string folder);

  /// Whether the file at `path`, relative to the folder, was written by a fetch.
  bool has(const std::string& path) const { return paths_.contains(path); }

  /// Keeps that it is; before the file gets its name.
  Outcome add(const std::string& path);

 private:
  std::string file_;
  std::set<std::string> paths_;
  bool is_plain_ = true;  ///< neither link nor pipe stands there
};

}  // namespace hyades::cli
