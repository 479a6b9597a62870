#include "coordinator/job_store/removals.h"

#include <array>

#include "coordinator/job_store/database.h"

namespace hyades::coordinator {
namespace {

/// What refers to a job. Each drops the first ?2 rows of job ?1 in some order that has an index.
constexpr std::array kDrops = {
    "DELETE FROM outputs WHERE number IN "
    "(SELECT number FROM outputs WHERE job = ?1 ORDER BY path LIMIT ?2)",
    "DELETE FROM frames WHERE job = ?1 AND frame IN "
    "(SELECT frame FROM frames WHERE job = ?1 ORDER BY frame LIMIT ?2)",
    "DELETE FROM parts WHERE job = ?1 AND frame IN "
    "(SELECT frame FROM parts WHERE job = ?1 ORDER BY frame LIMIT ?2)",
    "DELETE FROM lines WHERE number IN "
    "(SELECT number FROM lines WHERE job = ?1 ORDER BY number LIMIT ?2)",
};

/// While it lives rows may go that others refer to, which then stay.
class WithoutCascade {
 public:
  explicit WithoutCascade(sqlite3* db) : db_(db) { set("OFF"); }
  ~WithoutCascade() { set("ON"); }
  WithoutCascade(const WithoutCascade&) = delete;
  WithoutCascade& operator=(const WithoutCascade&) = delete;

 private:
  void set(const std::string& value) { (void)Query(db_, "PRAGMA foreign_keys=" + value).run(); }
  sqlite3* db_;
};

}  // namespace

core::Status mark_removed(sqlite3* db, uint64_t job) {
  const WithoutCascade alone(db);  // has to outlive the transaction
  Transaction transaction(db);
  if (core::Status begun = transaction.status(); !begun) return begun;
  for (const char* sql :
       {"INSERT INTO removals SELECT id FROM jobs WHERE id = ?", "DELETE FROM jobs WHERE id = ?"}) {
    if (core::Status done = Query(db, sql).bind(number(job)).run(); !done) return done;
  }
  return transaction.commit();
}

core::Result<bool> drop_removed_rows(sqlite3* db, uint32_t rows) {
  Transaction transaction(db);
  if (core::Status begun = transaction.status(); !begun) return begun.error();
  int64_t job = 0;
  {
    Query first(db, "SELECT job FROM removals ORDER BY job LIMIT 1");
    const bool some = first.next();
    if (core::Status read = first.status(); !read) return read.error();
    if (!some) return false;
    job = first.integer(0);
  }
  int64_t left = rows;
  for (const char* sql : kDrops) {
    if (core::Status done = Query(db, sql).bind(job).bind(left).run(); !done) return done.error();
    left -= sqlite3_changes(db);
    if (left > 0) continue;
    if (core::Status done = transaction.commit(); !done) return done.error();
    return true;
  }
  for (const char* sql :
       {"DELETE FROM specs WHERE job = ?", "DELETE FROM removals WHERE job = ?"}) {
    if (core::Status done = Query(db, sql).bind(job).run(); !done) return done.error();
  }
  if (core::Status done = transaction.commit(); !done) return done.error();
  return true;
}

}  // namespace hyades::coordinator
