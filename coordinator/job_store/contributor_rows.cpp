#include "coordinator/job_store/contributor_rows.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "coordinator/job_store/removals.h"
#include "coordinator/sql/connection.h"
#include "core/base/hash.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMarkBytes = 8;
constexpr size_t kMostRuns = 40;  // that a line of a log tells

/// What stands for a worker; zeros for one without a name.
std::string mark_of(const std::string& worker) {
  if (worker.empty()) return std::string(kMarkBytes, '\0');
  const core::Sha256 hash = core::sha256(worker);
  return {reinterpret_cast<const char*>(hash.data()), kMarkBytes};
}

std::string pack(const std::vector<std::string>& workers) {
  std::vector<std::string> marks;
  marks.reserve(workers.size());
  for (const std::string& worker : workers) marks.push_back(mark_of(worker));
  std::sort(marks.begin(), marks.end());
  marks.erase(std::unique(marks.begin(), marks.end()), marks.end());
  if (marks.size() > kMostContributors) marks.assign(1, mark_of({}));
  std::string packed;
  for (const std::string& mark : marks) packed += mark;
  return packed;
}

bool holds(const std::string& packed, const std::string& mark) {
  for (size_t at = 0; at + kMarkBytes <= packed.size(); at += kMarkBytes) {
    if (packed.compare(at, kMarkBytes, mark) == 0) return true;
  }
  return false;
}

/// Whether the worker had, or may have had, one of these parts of a frame that was finished then.
bool had_part(const std::string& worker, uint64_t since, uint64_t moment,
              const std::string& parts) {
  return moment > since && (holds(parts, mark_of(worker)) || holds(parts, mark_of({})));
}

}  // namespace

core::Status store_contributors(SqlConnection& db, uint64_t job, const StoredFrame& frame) {
  if (frame.parts.empty()) return {};
  return Query(db, "INSERT INTO parts (job, frame, moment, workers) VALUES (?, ?, ?, ?)")
      .bind(static_cast<int64_t>(job))
      .bind(int64_t{frame.frame})
      .bind(static_cast<int64_t>(frame.moment))
      .bind_blob(pack(frame.parts))
      .run();
}

core::Result<bool> find_frames_of(SqlConnection& db, const std::string& worker, uint64_t since,
                                  FrameOfJob& last, uint32_t limit,
                                  std::vector<FrameOfJob>& found) {
  Query rows(db,
             "SELECT job, frame, moment, workers FROM parts WHERE (job, frame) > (?, ?) "
             "ORDER BY job, frame LIMIT ?");
  rows.bind(number(last.job)).bind(int64_t{last.frame}).bind(int64_t{limit});
  uint32_t looked = 0;
  for (; rows.next(); ++looked) {
    last = {static_cast<uint64_t>(rows.integer(0)), static_cast<int32_t>(rows.integer(1))};
    if (had_part(worker, since, static_cast<uint64_t>(rows.integer(2)), rows.bytes(3))) {
      found.push_back(last);
    }
  }
  if (core::Status status = rows.status(); !status) return status.error();
  return looked == limit;
}

core::Result<std::vector<SuspectFrames>> make_suspect(SqlConnection& db, const std::string& worker,
                                                      uint64_t since,
                                                      std::vector<FrameOfJob> frames) {
  std::sort(frames.begin(), frames.end());
  std::vector<SuspectFrames> jobs;
  for (const FrameOfJob& one : frames) {
    Query row(db, "SELECT moment, workers FROM parts WHERE job = ?1 AND frame = ?2" + kJobIsThere);
    row.bind(number(one.job)).bind(int64_t{one.frame});
    const bool had =
        row.next() && had_part(worker, since, static_cast<uint64_t>(row.integer(0)), row.bytes(1));
    if (core::Status status = row.status(); !status) return status.error();
    if (!had) continue;
    Query suspect(db,
                  "UPDATE frames SET doubtful = 1 WHERE job = ? AND frame = ? AND doubtful = 0");
    suspect.bind(number(one.job)).bind(int64_t{one.frame});
    if (core::Status done = suspect.run(); !done) return done.error();
    if (suspect.changed() == 0) continue;
    if (jobs.empty() || jobs.back().job != one.job) jobs.push_back({one.job, {}});
    jobs.back().frames.push_back(one.frame);
  }
  return jobs;
}

core::Status store_trust(SqlConnection& db, const std::vector<StoredTrust>& workers) {
  Transaction transaction(db);
  if (core::Status begun = transaction.status(); !begun) return begun;
  for (const StoredTrust& worker : workers) {
    core::Status done = Query(db,
                              "INSERT INTO trusted (worker, moment) VALUES (?, ?) "
                              "ON CONFLICT (worker) DO UPDATE SET moment = excluded.moment")
                            .bind(worker.worker)
                            .bind(static_cast<int64_t>(worker.moment))
                            .run();
    if (!done) return done;
  }
  // Ids of workers that never come again must not heap up; of whom is forgotten more is suspect.
  core::Status cut = Query(db,
                           "DELETE FROM trusted WHERE worker NOT IN "
                           "(SELECT worker FROM trusted ORDER BY moment DESC LIMIT ?)")
                         .bind(int64_t{kMostTrusted})
                         .run();
  if (!cut) return cut;
  return transaction.commit();
}

core::Result<std::vector<StoredTrust>> read_trust(SqlConnection& db) {
  std::vector<StoredTrust> workers;
  Query rows(db, "SELECT worker, moment FROM trusted ORDER BY worker");
  while (rows.next()) workers.push_back({rows.bytes(0), static_cast<uint64_t>(rows.integer(1))});
  if (core::Status status = rows.status(); !status) return status.error();
  return workers;
}

std::string tell_frames(const std::vector<int32_t>& frames) {
  std::string text;
  size_t runs = 0;
  for (size_t i = 0; i < frames.size();) {
    if (runs++ == kMostRuns) return text + fmt::format(" and {} more", frames.size() - i);
    size_t last = i;
    while (last + 1 < frames.size() && frames[last + 1] == frames[last] + 1) ++last;
    if (!text.empty()) text += ", ";
    text +=
        last == i ? fmt::format("{}", frames[i]) : fmt::format("{}-{}", frames[i], frames[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace hyades::coordinator
