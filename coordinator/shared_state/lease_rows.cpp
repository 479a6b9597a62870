#include "coordinator/shared_state/lease_rows.h"

namespace hyades::coordinator {

core::Result<LeaseRow> read_lease(SqlConnection& db) {
  Query query(db, "SELECT incarnation, renewed, holder, url, lease_ms FROM lease");
  LeaseRow row;
  if (query.next()) {
    row.incarnation = static_cast<uint64_t>(query.integer(0));
    row.renewed = static_cast<uint64_t>(query.integer(1));
    row.holder = query.bytes(2);
    row.url = query.bytes(3);
    row.time = std::chrono::milliseconds(query.integer(4));
  }
  if (core::Status read = query.status(); !read) return read.error();
  return row;
}

core::Result<std::optional<uint64_t>> take_over(SqlConnection& db, const LeaseRow& last,
                                                const std::string& holder,
                                                std::chrono::milliseconds time) {
  Transaction transaction(db);
  if (core::Status begun = transaction.status(); !begun) return begun.error();
  Query raise(db, "UPDATE leader SET incarnation = incarnation + 1 WHERE incarnation = ?");
  if (core::Status done = raise.bind(number(last.incarnation)).run(); !done) return done.error();
  if (raise.changed() == 0) return std::optional<uint64_t>();
  const uint64_t incarnation = last.incarnation + 1;
  core::Status done =
      Query(db, "UPDATE lease SET incarnation = ?, renewed = 0, holder = ?, url = '', lease_ms = ?")
          .bind(number(incarnation))
          .bind(holder)
          .bind(int64_t{time.count()})
          .run();
  if (done) done = transaction.commit();
  if (!done) return done.error();
  return std::optional(incarnation);
}

core::Result<bool> renew_lease(SqlConnection& db, uint64_t incarnation, const std::string& url) {
  Query query(db, "UPDATE lease SET renewed = renewed + 1, url = ? WHERE incarnation = ?");
  if (core::Status done = query.bind(url).bind(number(incarnation)).run(); !done) {
    return done.error();
  }
  return query.changed() == 1;
}

core::Status raise_incarnation(SqlConnection& db, uint64_t least) {
  Transaction transaction(db);
  core::Status done = transaction.status();
  for (const char* sql :
       {"UPDATE leader SET incarnation = ? WHERE incarnation < ? AND NOT EXISTS "
        "(SELECT 1 FROM lease WHERE holder <> '')",
        "UPDATE lease SET incarnation = ? WHERE incarnation < ? AND holder = ''"}) {
    if (done) done = Query(db, sql).bind(number(least)).bind(number(least)).run();
  }
  return done ? transaction.commit() : done;
}

core::Status step_down(SqlConnection& db, uint64_t incarnation) {
  return Query(db, "UPDATE lease SET holder = '' WHERE incarnation = ?")
      .bind(number(incarnation))
      .run();
}

}  // namespace hyades::coordinator
