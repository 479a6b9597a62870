#include "coordinator/job_store/output_rows.h"

#include "coordinator/job_store/removals.h"
#include "coordinator/sql/connection.h"

namespace hyades::coordinator {
namespace {

constexpr const char* kSelect = "SELECT path, frame, size, sha256, number FROM outputs ";

StoredOutput read_row(const Query& row) {
  return {row.bytes(0), static_cast<int32_t>(row.integer(1)), static_cast<uint64_t>(row.integer(2)),
          row.bytes(3), static_cast<uint64_t>(row.integer(4))};
}

core::Result<std::vector<StoredOutput>> read_all(Query& rows) {
  std::vector<StoredOutput> outputs;
  while (rows.next()) outputs.push_back(read_row(rows));
  if (core::Status status = rows.status(); !status) return status.error();
  return outputs;
}

core::Status delete_output(SqlConnection& db, uint64_t job, const std::string& path) {
  return Query(db, "DELETE FROM outputs WHERE job = ? AND path = ?")
      .bind(number(job))
      .bind(path)
      .run();
}

}  // namespace

core::Status put_outputs(SqlConnection& db, uint64_t job,
                         const std::vector<StoredOutput>& outputs) {
  if (!outputs.empty()) {
    if (core::Status there = check_job_is_there(db, job); !there) return there;
  }
  for (const StoredOutput& output : outputs) {
    // Not in its place: who follows the outputs hears of a new number alone.
    if (core::Status gone = delete_output(db, job, output.path); !gone) return gone;
    Query insert(db, "INSERT INTO outputs (job, path, frame, size, sha256) VALUES (?, ?, ?, ?, ?)");
    const core::Status done = insert.bind(number(job))
                                  .bind(output.path)
                                  .bind(int64_t{output.frame})
                                  .bind(number(output.size))
                                  .bind_blob(output.sha256)
                                  .run();
    if (!done) return done;
  }
  return {};
}

core::Status delete_outputs(SqlConnection& db, uint64_t job,
                            const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (core::Status done = delete_output(db, job, path); !done) return done;
    // What lies in the folder, as the index by paths has it: '0' comes after '/'.
    const core::Status below =
        Query(db, "DELETE FROM outputs WHERE job = ? AND path > ? AND path < ?")
            .bind(number(job))
            .bind(path + "/")
            .bind(path + "0")
            .run();
    if (!below) return below;
  }
  return {};
}

core::Result<std::vector<StoredOutput>> read_outputs(SqlConnection& db, uint64_t job,
                                                     uint64_t after, uint32_t limit) {
  Query rows(db, std::string(kSelect) + "WHERE job = ?1 AND number > ?2" + kJobIsThere +
                     "ORDER BY number LIMIT ?3");
  rows.bind(number(job)).bind(number(after)).bind(int64_t{limit});
  return read_all(rows);
}

core::Result<std::vector<StoredOutput>> read_outputs_of(SqlConnection& db, uint64_t job,
                                                        int32_t frame) {
  Query rows(
      db, std::string(kSelect) + "WHERE job = ?1 AND frame = ?2" + kJobIsThere + "ORDER BY number");
  rows.bind(number(job)).bind(int64_t{frame});
  return read_all(rows);
}

core::Result<std::optional<StoredOutput>> read_output(SqlConnection& db, uint64_t job,
                                                      const std::string& path) {
  Query row(db, std::string(kSelect) + "WHERE job = ?1 AND path = ?2" + kJobIsThere);
  row.bind(number(job)).bind(path);
  if (row.next()) return std::optional(read_row(row));
  if (core::Status status = row.status(); !status) return status.error();
  return std::optional<StoredOutput>();
}

}  // namespace hyades::coordinator
