#include "coordinator/job_store/frame_rows.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "coordinator/job_store/contributor_rows.h"
#include "coordinator/job_store/removals.h"
#include "coordinator/sql/connection.h"

namespace hyades::coordinator {

core::Result<std::vector<StoredFrame>> read_frames(SqlConnection& db, uint64_t job,
                                                   std::optional<int32_t> after, uint32_t limit) {
  Query rows(db,
             "SELECT frame, done, reason, class, restarts, doubtful, black FROM frames "
             "WHERE job = ?1 AND frame > ?2" +
                 kJobIsThere + "ORDER BY frame LIMIT ?3");
  rows.bind(number(job)).bind(after ? int64_t{*after} : INT64_MIN).bind(int64_t{limit});
  std::vector<StoredFrame> frames;
  while (rows.next()) {
    StoredFrame& frame = frames.emplace_back();
    frame.frame = static_cast<int32_t>(rows.integer(0));
    frame.done = rows.integer(1) != 0;
    frame.reason = rows.bytes(2);
    frame.worker_class = rows.bytes(3);
    frame.restarts = static_cast<uint32_t>(rows.integer(4));
    frame.suspect = rows.integer(5) != 0;
    frame.black = rows.integer(6) != 0;
  }
  if (core::Status status = rows.status(); !status) return status.error();
  return frames;
}

namespace {

/// Frames of which `mark` holds, in order, at most `limit`.
core::Result<std::vector<int32_t>> read_marked(SqlConnection& db, const std::string& mark,
                                               uint64_t job, uint32_t limit) {
  Query rows(db, "SELECT frame FROM frames WHERE job = ?1 AND " + mark + kJobIsThere +
                     "ORDER BY frame LIMIT ?2");
  rows.bind(number(job)).bind(int64_t{limit});
  std::vector<int32_t> frames;
  while (rows.next()) frames.push_back(static_cast<int32_t>(rows.integer(0)));
  if (core::Status status = rows.status(); !status) return status.error();
  return frames;
}

}  // namespace

core::Result<std::vector<int32_t>> read_suspect_frames(SqlConnection& db, uint64_t job,
                                                       uint32_t limit) {
  return read_marked(db, "doubtful <> 0", job, limit);
}

core::Result<std::vector<int32_t>> read_black(SqlConnection& db, uint64_t job, uint32_t limit) {
  return read_marked(db, "black <> 0", job, limit);
}

core::Status put_frame(SqlConnection& db, uint64_t job, const StoredFrame& frame) {
  if (core::Status there = check_job_is_there(db, job); !there) return there;
  if (core::Status gone = delete_frame(db, job, frame.frame); !gone) return gone;
  const core::Status done = Query(db,
                                  "INSERT INTO frames (job, frame, done, reason, class, restarts, "
                                  "black) VALUES (?, ?, ?, ?, ?, ?, ?)")
                                .bind(number(job))
                                .bind(int64_t{frame.frame})
                                .bind(int64_t{frame.done})
                                .bind(frame.reason)
                                .bind(frame.worker_class)
                                .bind(int64_t{frame.restarts})
                                .bind(int64_t{frame.black})
                                .run();
  return done ? store_contributors(db, job, frame) : done;
}

core::Status delete_frame(SqlConnection& db, uint64_t job, int32_t frame) {
  for (const char* sql : {"DELETE FROM frames WHERE job = ? AND frame = ?",
                          "DELETE FROM parts WHERE job = ? AND frame = ?",
                          "DELETE FROM outputs WHERE job = ? AND frame = ?"}) {
    if (core::Status done = Query(db, sql).bind(number(job)).bind(int64_t{frame}).run(); !done) {
      return done;
    }
  }
  return {};
}

core::Result<bool> delete_failed_frames(SqlConnection& db, uint64_t job,
                                        std::optional<int32_t>& after, uint32_t limit) {
  const auto frames = read_frames(db, job, after, limit);
  if (!frames) return frames.error();
  const auto has_failed = [](const StoredFrame& frame) { return !frame.done; };
  if (std::any_of(frames->begin(), frames->end(), has_failed)) {
    const std::string failed =
        "FROM frames WHERE job = ?1 AND frame BETWEEN ?2 AND ?3 AND done = 0";
    for (const std::string& sql :
         {"DELETE FROM parts WHERE job = ?1 AND frame IN (SELECT frame " + failed + ")",
          "DELETE FROM outputs WHERE job = ?1 AND frame IN (SELECT frame " + failed + ")",
          "DELETE " + failed}) {
      const core::Status done = Query(db, sql)
                                    .bind(number(job))
                                    .bind(int64_t{frames->front().frame})
                                    .bind(int64_t{frames->back().frame})
                                    .run();
      if (!done) return done.error();
    }
  }
  if (!frames->empty()) after = frames->back().frame;
  return frames->size() == limit;
}

}  // namespace hyades::coordinator
