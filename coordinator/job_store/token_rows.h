#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/job_store/job_store.h"
#include "coordinator/sql/connection.h"

namespace hyades::coordinator {

// The rows of the table `tokens`, for the store, which has the lock.

/// All tokens, also those that are of no use any more, the oldest first.
core::Result<std::vector<StoredToken>> read_tokens(SqlConnection& db);
/// An error where the token's id is there already.
core::Status insert_token(SqlConnection& db, const StoredToken& token);
/// The token keeps its row, which tells whose it was.
core::Status mark_revoked(SqlConnection& db, const std::string& id, int64_t revoked_ms);
/// Removes the token's row; OK where there is none.
core::Status delete_token(SqlConnection& db, const std::string& id);
/// Stores when tokens were last used: all of it at once, or nothing.
core::Status update_uses(SqlConnection& db, const std::vector<TokenUse>& uses);

}  // namespace hyades::coordinator
