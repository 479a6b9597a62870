#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "coordinator/shared_state/leader_watch.h"
#include "coordinator/sql/connection.h"
#include "core/base/result.h"

namespace hyades::coordinator {

// Who leads, as two tables of one row each: `leader` has the incarnation, which changes only when
// somebody takes over and on which every write of a leader is conditional; `lease` has what changes
// all the time. So renewals and writes do not wait for each other.

/// Reads the lease.
core::Result<LeaseRow> read_lease(SqlConnection& db);

/// Makes `holder` the leader after `last`, with a lease of `time`, unless somebody else has become
/// that already. Waits for transactions in which the leader before writes; afterwards it can write
/// nothing. The new incarnation; nothing where somebody else was faster.
core::Result<std::optional<uint64_t>> take_over(SqlConnection& db, const LeaseRow& last,
                                                const std::string& holder,
                                                std::chrono::milliseconds time);

/// Says that the leader with this incarnation is there, and where its dashboard is. Whether it
/// still leads.
core::Result<bool> renew_lease(SqlConnection& db, uint64_t incarnation, const std::string& url);

/// Where nobody leads, the next incarnation will be greater than `least`.
core::Status raise_incarnation(SqlConnection& db, uint64_t least);

/// The leader with this incarnation, if it still leads, does so no more: others need not wait.
core::Status step_down(SqlConnection& db, uint64_t incarnation);

}  // namespace hyades::coordinator
