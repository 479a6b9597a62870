#include "coordinator/job_store/job_rows.h"

#include <string_view>

namespace hyades::coordinator {
namespace {

constexpr std::string_view kJobColumns =
    "id, key, name, owner, priority, state, frames, frames_done, frames_failed, samples, "
    "submitted_ms, ended_ms, reason, core_ns, preview, owner_proven, options, "
    "samples_done, begun_ms, busy_ns";

constexpr int64_t kMsPerHour = 3'600'000;

StoredJob job_of(const Query& row) {
  StoredJob job;
  job.id = static_cast<uint64_t>(row.integer(0));
  job.key = row.bytes(1);
  job.name = row.bytes(2);
  job.owner = row.bytes(3);
  job.priority = static_cast<int>(row.integer(4));
  job.state = static_cast<StoredState>(row.integer(5));
  job.frames = static_cast<uint32_t>(row.integer(6));
  job.frames_done = static_cast<uint32_t>(row.integer(7));
  job.frames_failed = static_cast<uint32_t>(row.integer(8));
  job.samples = static_cast<uint64_t>(row.integer(9));
  job.submitted_ms = row.integer(10);
  job.ended_ms = row.integer(11);
  job.reason = row.bytes(12);
  job.core_ns = static_cast<uint64_t>(row.integer(13));
  if (!row.is_null(14)) job.preview = static_cast<int32_t>(row.integer(14));
  job.owner_proven = row.integer(15) != 0;
  job.options = row.bytes(16);
  job.samples_done = static_cast<uint64_t>(row.integer(17));
  job.begun_ms = row.integer(18);
  job.busy_ns = static_cast<uint64_t>(row.integer(19));
  return job;
}

void bind_changing(Query& query, const StoredJob& job) {
  query.bind(int64_t{job.priority})
      .bind(static_cast<int64_t>(job.state))
      .bind(int64_t{job.frames})
      .bind(int64_t{job.frames_done})
      .bind(int64_t{job.frames_failed})
      .bind(number(job.samples))
      .bind(job.submitted_ms)
      .bind(job.ended_ms)
      .bind(job.reason)
      .bind(number(job.core_ns))
      .bind(number(job.samples_done))
      .bind(job.begun_ms)
      .bind(number(job.busy_ns));
  if (job.preview) {
    query.bind(int64_t{*job.preview});
  } else {
    query.bind_null();
  }
}

}  // namespace

core::Result<uint64_t> insert_job(SqlConnection& db, const StoredJob& job, bool old_columns) {
  // Of the old columns this one alone has no default.
  Query insert(db,
               "INSERT INTO jobs (key, name, owner, priority, state, frames, frames_done, "
               "frames_failed, samples, submitted_ms, ended_ms, reason, core_ns, samples_done, "
               "begun_ms, busy_ns, preview, owner_proven, options" +
                   std::string(old_columns ? ", max_workers" : "") +
                   ") VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?" +
                   (old_columns ? ", 0" : "") + ") RETURNING id");
  if (job.key.empty()) {
    insert.bind_null();
  } else {
    insert.bind(job.key);
  }
  insert.bind(job.name).bind(job.owner);
  bind_changing(insert, job);
  insert.bind(int64_t{job.owner_proven ? 1 : 0}).bind_blob(job.options);
  const uint64_t id = insert.next() ? static_cast<uint64_t>(insert.integer(0)) : 0;
  if (core::Status done = insert.run(); !done) return done.error();
  const core::Status done = Query(db, "INSERT INTO specs (job, spec) VALUES (?, ?)")
                                .bind(number(id))
                                .bind_blob(job.spec)
                                .run();
  if (!done) return done.error();
  return id;
}

core::Status update_job_row(SqlConnection& db, const StoredJob& job) {
  Query update(db,
               "UPDATE jobs SET priority = ?, state = ?, frames = ?, "
               "frames_done = ?, frames_failed = ?, samples = ?, submitted_ms = ?, "
               "ended_ms = ?, reason = ?, core_ns = ?, samples_done = ?, begun_ms = ?, "
               "busy_ns = ?, preview = ? WHERE id = ?");
  bind_changing(update, job);
  return update.bind(number(job.id)).run();
}

core::Result<std::optional<uint64_t>> find_key(SqlConnection& db, const std::string& key) {
  Query known(db, "SELECT id FROM jobs WHERE key = ?");  // none has the empty one
  known.bind(key);
  if (known.next()) return std::optional(static_cast<uint64_t>(known.integer(0)));
  if (core::Status status = known.status(); !status) return status.error();
  return std::optional<uint64_t>();
}

core::Result<std::optional<StoredJob>> read_summary(SqlConnection& db, uint64_t id) {
  Query row(db, "SELECT " + std::string(kJobColumns) + " FROM jobs WHERE id = ?");
  row.bind(number(id));
  if (row.next()) return std::optional(job_of(row));
  if (core::Status status = row.status(); !status) return status.error();
  return std::optional<StoredJob>();
}

core::Result<std::optional<StoredJob>> read_job(SqlConnection& db, uint64_t id) {
  auto job = read_summary(db, id);
  if (!job || !*job) return job;
  Query spec(db, "SELECT spec FROM specs WHERE job = ?");
  spec.bind(number(id));
  if (spec.next()) (*job)->spec = spec.bytes(0);
  if (core::Status status = spec.status(); !status) return status.error();
  return job;
}

core::Result<std::optional<StoredState>> read_state(SqlConnection& db, uint64_t id) {
  Query row(db, "SELECT state FROM jobs WHERE id = ?");
  row.bind(number(id));
  if (row.next()) return std::optional(static_cast<StoredState>(row.integer(0)));
  if (core::Status status = row.status(); !status) return status.error();
  return std::optional<StoredState>();
}

core::Result<std::vector<uint64_t>> read_open_jobs(SqlConnection& db) {
  std::vector<uint64_t> ids;
  Query rows(db, "SELECT id FROM jobs WHERE state < 3 ORDER BY id");
  while (rows.next()) ids.push_back(static_cast<uint64_t>(rows.integer(0)));
  if (core::Status status = rows.status(); !status) return status.error();
  return ids;
}

core::Result<std::vector<StoredJob>> read_jobs(SqlConnection& db, bool ended,
                                               const std::string& owner, uint64_t before,
                                               uint32_t limit) {
  // Without those that have ended the partial index does the work.
  Query rows(db, "SELECT " + std::string(kJobColumns) + " FROM jobs WHERE id < ?" +
                     (ended ? "" : " AND state < 3") + (owner.empty() ? "" : " AND owner = ?") +
                     " ORDER BY id DESC LIMIT ?");
  rows.bind(before == 0 ? INT64_MAX : number(before));
  if (!owner.empty()) rows.bind(owner);
  rows.bind(int64_t{limit});
  std::vector<StoredJob> jobs;
  while (rows.next()) jobs.push_back(job_of(rows));
  if (core::Status status = rows.status(); !status) return status.error();
  return jobs;
}

core::Result<std::vector<StoredSpec>> read_specs(SqlConnection& db, uint64_t after,
                                                 uint64_t most_bytes) {
  // First their lengths: PostgreSQL hands over all rows of an answer at once.
  Query lengths(db,
                "SELECT job, LENGTH(spec) FROM specs WHERE job > ? AND job IN "
                "(SELECT id FROM jobs) ORDER BY job LIMIT ?");
  lengths.bind(number(after)).bind(int64_t{kRowsAtOnce});
  int64_t last = number(after);
  for (uint64_t bytes = 0; (last == number(after) || bytes < most_bytes) && lengths.next();) {
    last = lengths.integer(0);
    bytes += static_cast<uint64_t>(lengths.integer(1));
  }
  if (core::Status status = lengths.status(); !status) return status.error();
  Query rows(db,
             "SELECT job, spec FROM specs WHERE job > ? AND job <= ? AND job IN "
             "(SELECT id FROM jobs) ORDER BY job");
  rows.bind(number(after)).bind(last);
  std::vector<StoredSpec> specs;
  while (rows.next()) specs.push_back({static_cast<uint64_t>(rows.integer(0)), rows.bytes(1)});
  if (core::Status status = rows.status(); !status) return status.error();
  return specs;
}

core::Result<uint64_t> read_core_ns(SqlConnection& db, const std::string& owner, int64_t since_ms) {
  Query sum(db, "SELECT CAST(SUM(core_ns) AS BIGINT) FROM core_time WHERE owner = ? AND hour >= ?");
  sum.bind(owner).bind(since_ms / kMsPerHour);
  const uint64_t total = sum.next() ? static_cast<uint64_t>(sum.integer(0)) : 0;
  if (core::Status status = sum.status(); !status) return status.error();
  return total;
}

}  // namespace hyades::coordinator
