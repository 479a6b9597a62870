#pragma once

#include <set>
#include <string>

#include "cli/client/failure.h"

namespace hyades::cli {

/// Which files of a folder `hyades fetch` has written, of which job and with which bytes: the file
/// `.hyades/fetched` in it has a line for each, "SHA256 JOB SUBMITTED PATH". A coordinator names
/// the files, so that without it one that is hostile could have others of the folder replaced; and
/// two jobs may name their pictures alike.
class FetchRecord {
 public:
  /// Of `folder`, which need not be there yet.
  explicit FetchRecord(std::string folder);

  /// Whether a fetch of this job has written a file of these bytes at `path`, relative to the
  /// folder. `job`: its id and when it was submitted, as other coordinators number theirs alike.
  bool has(const std::string& job, const std::string& path, const std::string& sha256) const {
    return lines_.contains(line_of(job, path, sha256));
  }

  /// Keeps that one has; before the file gets its name.
  Outcome add(const std::string& job, const std::string& path, const std::string& sha256);

 private:
  static std::string line_of(const std::string& job, const std::string& path,
                             const std::string& sha256) {
    return sha256 + " " + job + " " + path;
  }

  std::string file_;
  std::set<std::string> lines_;
  bool is_plain_ = true;  ///< neither link nor pipe stands there
};

}  // namespace hyades::cli
