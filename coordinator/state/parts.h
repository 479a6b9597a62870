#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/state/job_store.h"

namespace hyades::coordinator {

// Who had a part in finished frames: eight bytes of the SHA-256 of each worker's name,
// little-endian, sorted, or eight zeros for somebody who is not known; more than kMostParts workers
// are not told apart. So a frame takes two kilobytes at most.

inline constexpr size_t kMostParts = 256;

/// Within a transaction; replaces nothing.
core::Status store_parts(sqlite3* db, uint64_t job, const StoredFrame& frame);

/// Within a transaction: the frames that were finished after `since` and that the worker had a part
/// in, or may have had, are doubtful. Those that were so before are left out of the answer.
core::Result<std::vector<JobFrames>> doubt_parts_of(sqlite3* db, const std::string& worker,
                                                    uint64_t since);

core::Status store_trust(sqlite3* db, const std::vector<StoredTrust>& workers);
core::Result<std::vector<StoredTrust>> read_trust(sqlite3* db);

/// "1, 3-7 and 12 more": for a line of a log.
std::string tell_frames(const std::vector<int32_t>& frames);

}  // namespace hyades::coordinator
