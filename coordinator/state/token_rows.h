#pragma once

#include <string>
#include <vector>

#include "coordinator/state/database.h"
#include "coordinator/state/job_store.h"

namespace hyades::coordinator {

// The rows of the table `tokens`, for the store, which has the lock.

core::Result<std::vector<StoredToken>> read_tokens(sqlite3* db);
core::Status insert_token(sqlite3* db, const StoredToken& token);
core::Status mark_revoked(sqlite3* db, const std::string& id, int64_t revoked_ms);
/// All of them at once, or none.
core::Status update_uses(sqlite3* db, const std::vector<TokenUse>& uses);

}  // namespace hyades::coordinator
