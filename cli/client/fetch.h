#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cli/client/farm_client.h"
#include "cli/client/fetch_record.h"

namespace hyades::cli {

/// Whether a path that a coordinator names stays in the folder that it is put into: relative, no
/// "..", no empty or special parts, no control characters.
bool is_safe_output(const std::string& path);

/// Where files go, and what a coordinator, which names them, may do there.
struct FetchTarget {
  explicit FetchTarget(std::string into) : folder(std::move(into)), record(folder) {}
  std::string folder;
  std::string job;      ///< as FetchRecord has it
  bool hidden = false;  ///< write hidden files too: .bashrc, .git/hooks/... (OutputName::special)
  bool overwrite = false;  ///< replace whatever files are there
  FetchRecord record;

  /// Refuses a name, relative to the folder, that no file may have.
  Outcome check_name(const std::string& path) const;
  /// Whether no file stands at `path` but such as may be replaced: those that a fetch of the same
  /// job has written, and that are as it left them.
  bool may_write(const std::string& path) const;
  /// Keeps that a fetch of the job has written these bytes.
  Outcome note(const std::string& path, const std::string& sha256) {
    return record.add(job, path, sha256);
  }
};

/// What is said of files that are there and stay.
Failure not_replaced(const std::vector<std::string>& paths, const std::string& folder);

/// SHA-256 of the file, where it is a plain one that can be read; empty elsewhere.
std::string sha256_of_file(const std::string& path);

/// What a run of fetch has done.
struct Fetched {
  uint64_t files = 0;                ///< that are complete now
  uint64_t present = 0;              ///< of these, that were before
  uint64_t bytes = 0;                ///< that came
  std::vector<std::string> refused;  ///< paths that must not be replaced
};

/// Puts `file` of job `id` into the target: goes on where an earlier run stopped, checks the
/// SHA-256, and gives the file its name only then. A file that is there with the right bytes is
/// left alone; one that must not be replaced is noted in `totals`.
Outcome fetch_file(FarmClient& client, uint64_t id, const v1::OutputFile& file, FetchTarget& target,
                   const std::function<void(uint64_t)>& on_progress, Fetched& totals);

}  // namespace hyades::cli
