#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/job_store/job_store.h"
#include "coordinator/sql/connection.h"

namespace hyades::coordinator {

// Who had a part in finished frames: eight bytes of the SHA-256 of each worker's name,
// little-endian, sorted, or eight zeros for somebody who is not known; more than kMostContributors
// workers are not told apart. So a frame takes two kilobytes at most.

inline constexpr size_t kMostContributors = 256;

/// Stores who had a part in a frame of which nothing is stored yet; within a transaction.
core::Status store_contributors(SqlConnection& db, uint64_t job, const StoredFrame& frame);

/// A frame of some job.
struct FrameOfJob {
  uint64_t job = 0;
  int32_t frame = INT32_MIN;
  auto operator<=>(const FrameOfJob&) const = default;
};

/// Looks at `limit` finished frames behind `last`, which becomes the last one, and adds to `found`
/// those that were finished after `since` and that the worker had a part in, or may have had.
/// Whether there may be more.
core::Result<bool> find_frames_of(SqlConnection& db, const std::string& worker, uint64_t since,
                                  FrameOfJob& last, uint32_t limit, std::vector<FrameOfJob>& found);
/// Makes those of `frames` suspect of which that still holds, and returns those that were not so
/// before; within a transaction.
core::Result<std::vector<SuspectFrames>> make_suspect(SqlConnection& db, const std::string& worker,
                                                      uint64_t since,
                                                      std::vector<FrameOfJob> frames);

/// Stores when these workers could last be trusted; replaces earlier moments.
core::Status store_trust(SqlConnection& db, const std::vector<StoredTrust>& workers);
/// All workers of which that is kept.
core::Result<std::vector<StoredTrust>> read_trust(SqlConnection& db);

/// "1, 3-7 and 12 more": for a line of a log.
std::string tell_frames(const std::vector<int32_t>& frames);

}  // namespace hyades::coordinator
