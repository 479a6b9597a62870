#pragma once

#include <cstdint>
#include <string>

#include "cli/client/farm_client.h"

namespace hyades::cli {

/// Whether a path that a coordinator names stays in the folder that it is put into: relative, no
/// "..", no empty or special parts.
bool is_safe_output(const std::string& path);

/// What a run of fetch has done.
struct Fetched {
  uint64_t files = 0;    ///< that are complete now
  uint64_t present = 0;  ///< of these, that were before
  uint64_t bytes = 0;    ///< that came
};

/// Puts `file` of job `id` into `folder`: goes on where an earlier run stopped, checks the SHA-256,
/// and gives the file its name only then. A file that is there with the right bytes is left alone.
Outcome fetch_file(FarmClient& client, uint64_t id, const v1::OutputFile& file,
                   const std::string& folder, const std::function<void(uint64_t)>& on_progress,
                   Fetched& totals);

}  // namespace hyades::cli
