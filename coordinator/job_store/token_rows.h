#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/job_store/database.h"
#include "coordinator/job_store/job_store.h"

namespace hyades::coordinator {

// The rows of the table `tokens`, for the store, which has the lock.

/// JobStore::tokens(), add_token() and revoke_token().
core::Result<std::vector<StoredToken>> read_tokens(sqlite3* db);
core::Status insert_token(sqlite3* db, const StoredToken& token);
core::Status mark_revoked(sqlite3* db, const std::string& id, int64_t revoked_ms);
/// JobStore::note_uses(): all of them at once, or none.
core::Status update_uses(sqlite3* db, const std::vector<TokenUse>& uses);

}  // namespace hyades::coordinator
