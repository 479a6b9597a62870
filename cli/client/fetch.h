#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

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
  bool hidden = false;  ///< write hidden files too: .bashrc, .git/hooks/... (OutputName::special)
  bool overwrite = false;  ///< replace files that no fetch has written
  FetchRecord record;

  /// Refuses a name, relative to the folder, that no file may have.
  Outcome check_name(const std::string& path) const;
  /// Refuses `path` also where a file is there that must not be replaced.
  Outcome check(const std::string& path) const;
};

/// What a run of fetch has done.
struct Fetched {
  uint64_t files = 0;    ///< that are complete now
  uint64_t present = 0;  ///< of these, that were before
  uint64_t bytes = 0;    ///< that came
};

/// Puts `file` of job `id` into the target: goes on where an earlier run stopped, checks the
/// SHA-256, and gives the file its name only then. A file that is there with the right bytes is
/// left alone.
Outcome fetch_file(FarmClient& client, uint64_t id, const v1::OutputFile& file, FetchTarget& target,
                   const std::function<void(uint64_t)>& on_progress, Fetched& totals);

}  // namespace hyades::cli
