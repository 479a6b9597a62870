#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/job_store/job_store.h"

namespace hyades::coordinator {

// Who had a part in finished frames: eight bytes of the SHA-256 of each worker's name,
// little-endian, sorted, or eight zeros for somebody who is not known; more than kMostContributors
// workers are not told apart. So a frame takes two kilobytes at most.

inline constexpr size_t kMostContributors = 256;

/// Stores who had a part in a frame of which nothing is stored yet; within a transaction.
core::Status store_contributors(sqlite3* db, uint64_t job, const StoredFrame& frame);

/// Makes doubtful the frames that were finished after `since` and that the worker had a part in, or
/// may have had, and returns those that were not so before; within a transaction.
core::Result<std::vector<JobFrames>> suspect_frames_of(sqlite3* db, const std::string& worker,
                                                       uint64_t since);

/// JobStore::trust() and trusted().
core::Status store_trust(sqlite3* db, const std::vector<StoredTrust>& workers);
core::Result<std::vector<StoredTrust>> read_trust(sqlite3* db);

/// "1, 3-7 and 12 more": for a line of a log.
std::string tell_frames(const std::vector<int32_t>& frames);

}  // namespace hyades::coordinator
