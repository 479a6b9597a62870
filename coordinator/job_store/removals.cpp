#include "coordinator/job_store/removals.h"

#include <array>

#include <fmt/format.h>

namespace hyades::coordinator {
namespace {

/// What belongs to a job. Each drops the first ?2 rows of job ?1 in some order that has an index.
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

}  // namespace

core::Status check_job_is_there(SqlConnection& db, uint64_t job) {
  Query found(db, "SELECT id FROM jobs WHERE id = ?");
  found.bind(number(job));
  if (found.next()) return {};
  if (core::Status status = found.status(); !status) return status;
  return core::Error{fmt::format("the job store: there is no job {}", job)};
}

core::Status mark_removed(SqlConnection& db, uint64_t job) {
  Transaction transaction(db);
  if (core::Status begun = transaction.status(); !begun) return begun;
  for (const char* sql :
       {"INSERT INTO removals SELECT id FROM jobs WHERE id = ?", "DELETE FROM jobs WHERE id = ?"}) {
    if (core::Status done = Query(db, sql).bind(number(job)).run(); !done) return done;
  }
  return transaction.commit();
}

core::Result<bool> drop_removed_rows(SqlConnection& db, uint32_t rows) {
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
    Query drop(db, sql);
    if (core::Status done = drop.bind(job).bind(left).run(); !done) return done.error();
    left -= drop.changed();
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
