#include "coordinator/job_store/token_rows.h"

#include <cstdint>

namespace hyades::coordinator {

core::Result<std::vector<StoredToken>> read_tokens(SqlConnection& db) {
  std::vector<StoredToken> tokens;
  Query rows(db,
             "SELECT id, name, role, hash, created_ms, expires_ms, used_ms, revoked_ms, pool, "
             "machines FROM tokens "
             "ORDER BY created_ms, id");
  while (rows.next()) {
    tokens.push_back({rows.bytes(0), rows.bytes(1), static_cast<int>(rows.integer(2)),
                      rows.bytes(3), rows.integer(4), rows.integer(5), rows.integer(6),
                      rows.integer(7), rows.bytes(8), static_cast<uint32_t>(rows.integer(9))});
  }
  if (core::Status status = rows.status(); !status) return status.error();
  return tokens;
}

core::Status insert_token(SqlConnection& db, const StoredToken& token) {
  return Query(db,
               "INSERT INTO tokens (id, name, role, hash, created_ms, expires_ms, used_ms, "
               "revoked_ms, pool, machines) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(token.id)
      .bind(token.name)
      .bind(int64_t{token.role})
      .bind_blob(token.hash)
      .bind(token.created_ms)
      .bind(token.expires_ms)
      .bind(token.used_ms)
      .bind(token.revoked_ms)
      .bind(token.pool)
      .bind(int64_t{token.machines})
      .run();
}

core::Status mark_revoked(SqlConnection& db, const std::string& id, int64_t revoked_ms) {
  return Query(db, "UPDATE tokens SET revoked_ms = ? WHERE id = ? AND revoked_ms = 0")
      .bind(revoked_ms)
      .bind(id)
      .run();
}

core::Status delete_token(SqlConnection& db, const std::string& id) {
  return Query(db, "DELETE FROM tokens WHERE id = ?").bind(id).run();
}

core::Status update_uses(SqlConnection& db, const std::vector<TokenUse>& uses) {
  Transaction transaction(db);
  if (core::Status begun = transaction.status(); !begun) return begun;
  for (const TokenUse& use : uses) {
    const core::Status done = Query(db, "UPDATE tokens SET used_ms = ? WHERE id = ?")
                                  .bind(use.used_ms)
                                  .bind(use.id)
                                  .run();
    if (!done) return done;
  }
  return transaction.commit();
}

}  // namespace hyades::coordinator
