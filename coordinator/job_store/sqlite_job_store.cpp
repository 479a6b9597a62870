#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "coordinator/job_store/incarnation_file.h"
#include "coordinator/job_store/job_store.h"
#include "coordinator/job_store/schema.h"
#include "coordinator/job_store/sql_job_store.h"

namespace hyades::coordinator {
namespace {

/// A few times what the largest transaction that frees room needs in the WAL.
constexpr uint64_t kReserve = uint64_t{1} << 20U;

/// Starts are counted in a file of their own, which a full disk takes.
core::Result<uint64_t> next_start(SqlConnection& db, const std::string& file) {
  uint64_t known = 0;
  {
    Query last(db, "SELECT MAX(incarnation) FROM starts");
    if (last.next()) known = static_cast<uint64_t>(last.integer(0));
    if (core::Status read = last.status(); !read) return read.error();
  }
  auto counted = count_start(file, known);
  // For older programs, which look nowhere else. A full disk does not take it.
  if (counted) (void)Query(db, "INSERT INTO starts VALUES (?)").bind(number(*counted)).run();
  return counted;
}

}  // namespace

core::Result<std::unique_ptr<JobStore>> open_sqlite_job_store(const std::string& path) {
  auto reserve = std::make_unique<ReserveFile>(path + ".reserve", kReserve);
  auto db = open_job_database(path);
  // To bring it to this schema takes some room.
  if (!db && reserve->release()) db = open_job_database(path);
  if (!db) return db.error();
  SqlJobStoreParts parts;
  parts.db = std::move(*db);
  parts.next_incarnation = [file = path + ".starts"](SqlConnection& starts) {
    return next_start(starts, file);
  };
  parts.reserve = std::move(reserve);
  parts.old_columns = true;
  return make_sql_job_store(std::move(parts));
}

}  // namespace hyades::coordinator
