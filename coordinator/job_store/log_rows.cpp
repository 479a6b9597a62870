#include "coordinator/job_store/log_rows.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "coordinator/job_store/removals.h"
#include "coordinator/sql/connection.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kLinesAtOnce = 100;  // the way to a database may be long

core::Status insert_lines(SqlConnection& db, uint64_t job, std::span<const StoredLine> lines) {
  std::string sql = "INSERT INTO lines (job, time_ms, level, frame, worker, text) VALUES ";
  for (size_t i = 0; i < lines.size(); ++i)
    sql += i == 0 ? "(?, ?, ?, ?, ?, ?)" : ", (?, ?, ?, ?, ?, ?)";
  Query insert(db, sql);
  for (const StoredLine& line : lines) {
    insert.bind(number(job)).bind(line.time_ms).bind(int64_t{line.level});
    if (line.frame) {
      insert.bind(int64_t{*line.frame});
    } else {
      insert.bind_null();
    }
    insert.bind(line.worker).bind(line.text);
  }
  return insert.run();
}

}  // namespace

core::Status LogRows::add(SqlConnection& db, uint64_t job, const std::vector<StoredLine>& lines) {
  if (!lines.empty()) {
    if (core::Status there = check_job_is_there(db, job); !there) return there;
  }
  for (std::span left(lines); !left.empty();) {
    const auto some = left.first(std::min(left.size(), kLinesAtOnce));
    if (core::Status done = insert_lines(db, job, some); !done) return done;
    left = left.subspan(some.size());
  }
  return drop_old(db, job, lines.size());
}

/// Jobs' lines are counted once, and kept count of from there on.
core::Status LogRows::drop_old(SqlConnection& db, uint64_t job, uint64_t added) {
  const auto [counted, fresh] = counts_.try_emplace(job, 0);
  if (fresh) {
    Query count(db, "SELECT COUNT(*) FROM lines WHERE job = ?");
    count.bind(number(job));
    if (count.next()) counted->second = static_cast<uint64_t>(count.integer(0));
    if (core::Status status = count.status(); !status) return status;
  } else {
    counted->second += added;
  }
  if (counted->second <= kMostLines) return {};
  counts_.erase(counted);
  Query old(db,
            "DELETE FROM lines WHERE job = ?1 AND number < (SELECT number FROM lines "
            "WHERE job = ?1 ORDER BY number DESC LIMIT 1 OFFSET ?2)");
  const core::Status gone =
      old.bind(number(job)).bind(number(kMostLines - kLinesDropped - 1)).run();
  if (!gone || old.changed() == 0) return gone;
  Query first(db,
              "UPDATE lines SET level = 2, frame = NULL, worker = '', text = ?2 "
              "WHERE number = (SELECT MIN(number) FROM lines WHERE job = ?1)");
  return first.bind(number(job))
      .bind("older lines were dropped: a job's log keeps the newest " + std::to_string(kMostLines))
      .run();
}

core::Result<std::vector<StoredLine>> read_lines(SqlConnection& db, uint64_t job, uint64_t after,
                                                 uint32_t limit) {
  Query rows(db,
             "SELECT time_ms, level, frame, worker, text, number FROM lines "
             "WHERE job = ?1 AND number > ?2" +
                 kJobIsThere + "ORDER BY number LIMIT ?3");
  rows.bind(number(job)).bind(number(after)).bind(int64_t{limit});
  std::vector<StoredLine> lines;
  while (rows.next()) {
    StoredLine line;
    line.time_ms = rows.integer(0);
    line.level = static_cast<int>(rows.integer(1));
    if (!rows.is_null(2)) line.frame = static_cast<int32_t>(rows.integer(2));
    line.worker = rows.bytes(3);
    line.text = rows.bytes(4);
    line.number = static_cast<uint64_t>(rows.integer(5));
    lines.push_back(std::move(line));
  }
  if (core::Status status = rows.status(); !status) return status.error();
  return lines;
}

}  // namespace hyades::coordinator
