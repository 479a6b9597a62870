#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "coordinator/job_store/contributor_rows.h"
#include "coordinator/job_store/database.h"
#include "coordinator/job_store/frame_rows.h"
#include "coordinator/job_store/incarnation_file.h"
#include "coordinator/job_store/job_store.h"
#include "coordinator/job_store/log_rows.h"
#include "coordinator/job_store/output_rows.h"
#include "coordinator/job_store/removals.h"
#include "coordinator/job_store/reserve_file.h"
#include "coordinator/job_store/token_rows.h"
#include "core/base/mutex.h"

namespace hyades::coordinator {
namespace {

constexpr std::string_view kJobColumns =
    "id, key, name, owner, priority, state, frames, frames_done, frames_failed, samples, "
    "submitted_ms, ended_ms, reason, core_ns, preview, owner_proven, options, "
    "samples_done, begun_ms, busy_ns";

constexpr int64_t kMsPerHour = 3'600'000;

/// A few times what the largest transaction that frees room needs in the WAL.
constexpr uint64_t kReserve = uint64_t{1} << 20U;

StoredJob read_job(const Query& row) {
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

class SqliteJobStore final : public JobStore {
 public:
  SqliteJobStore(Database db, const std::string& path)
      : db_(std::move(db)), starts_(path + ".starts"), reserve_(path + ".reserve", kReserve) {
    reserve_.keep();
  }

  core::Result<uint64_t> next_incarnation() override {
    const core::MutexLock lock(mutex_);
    Query last(db_.get(), "SELECT MAX(incarnation) FROM starts");
    const uint64_t known = last.next() ? static_cast<uint64_t>(last.integer(0)) : 0;
    if (core::Status read = last.status(); !read) return read.error();
    auto counted = count_start(starts_, known);
    if (!counted && reserve_.release()) counted = count_start(starts_, known);
    if (!counted) return counted;
    // For older programs, which look nowhere else. A full disk does not take it.
    (void)query("INSERT INTO starts VALUES (?)").bind(number(*counted)).run();
    return counted;
  }

  core::Result<std::string> secret() override {
    const core::MutexLock lock(mutex_);
    Query found(db_.get(), "SELECT text FROM secret");
    std::string text = found.next() ? found.bytes(0) : std::string();
    if (core::Status read = found.status(); !read) return read.error();
    if (text.empty()) return core::Error{"the store has lost its secret"};
    return text;
  }

  core::Result<Added> add_job(const StoredJob& job) override {
    const core::MutexLock lock(mutex_);
    const auto known = find_key(job.key);
    if (!known) return known.error();
    if (*known) return Added{**known, true};
    Transaction transaction(db_.get());
    if (core::Status begun = transaction.status(); !begun) return begun.error();
    Query insert(db_.get(),
                 "INSERT INTO jobs (key, name, owner, priority, state, frames, "
                 "frames_done, frames_failed, samples, submitted_ms, ended_ms, reason, core_ns, "
                 "samples_done, begun_ms, busy_ns, preview, owner_proven, options, max_workers) "
                 "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, 0)");
    if (job.key.empty()) {
      insert.bind_null();
    } else {
      insert.bind(job.key);
    }
    insert.bind(job.name).bind(job.owner);
    bind_changing(insert, job);
    insert.bind(int64_t{job.owner_proven ? 1 : 0}).bind_blob(job.options);
    if (core::Status done = insert.run(); !done) return done.error();
    const auto id = static_cast<uint64_t>(sqlite3_last_insert_rowid(db_.get()));
    core::Status done =
        query("INSERT INTO specs VALUES (?, ?)").bind(number(id)).bind_blob(job.spec).run();
    if (done) done = transaction.commit();
    if (!done) return done.error();
    reserve_.keep();
    return Added{id, false};
  }

  core::Result<std::optional<uint64_t>> job_of_key(const std::string& key) override {
    const core::MutexLock lock(mutex_);
    return find_key(key);
  }

  core::Status update_job(const StoredJob& job) override {
    return with_reserve([&] { return update_row(job); });
  }

  core::Status update_row(const StoredJob& job) {
    const core::MutexLock lock(mutex_);
    Query update(
        db_.get(),
        "UPDATE jobs SET priority = ?, state = ?, frames = ?, "
        "frames_done = ?, frames_failed = ?, samples = ?, submitted_ms = ?, "
        "ended_ms = ?, reason = ?, core_ns = ?, samples_done = ?, begun_ms = ?, busy_ns = ?, "
        "preview = ? WHERE id = ?");
    bind_changing(update, job);
    return update.bind(number(job.id)).run();
  }

  core::Status remove_job(uint64_t id) override {
    return with_reserve([&] {
      const core::MutexLock lock(mutex_);
      lines_.forget_counts();
      return mark_removed(db_.get(), id);
    });
  }

  core::Result<bool> drop_removed(uint32_t rows) override {
    const core::MutexLock lock(mutex_);
    return drop_removed_rows(db_.get(), rows);
  }

  core::Result<std::vector<uint64_t>> open_jobs() override {
    const core::MutexLock lock(mutex_);
    std::vector<uint64_t> ids;
    Query rows(db_.get(), "SELECT id FROM jobs WHERE state < 3 ORDER BY id");
    while (rows.next()) ids.push_back(static_cast<uint64_t>(rows.integer(0)));
    if (core::Status status = rows.status(); !status) return status.error();
    return ids;
  }

  core::Result<std::optional<StoredJob>> job(uint64_t id) override {
    const core::MutexLock lock(mutex_);
    auto job = find_job(id);
    if (!job || !*job) return job;
    Query spec = query("SELECT spec FROM specs WHERE job = ?");
    spec.bind(number(id));
    if (spec.next()) (*job)->spec = spec.bytes(0);
    if (core::Status status = spec.status(); !status) return status.error();
    return job;
  }

  core::Result<std::optional<StoredJob>> summary(uint64_t id) override {
    const core::MutexLock lock(mutex_);
    return find_job(id);
  }

  core::Result<std::optional<StoredState>> state(uint64_t id) override {
    const core::MutexLock lock(mutex_);
    Query row(db_.get(), "SELECT state FROM jobs WHERE id = ?");
    row.bind(number(id));
    if (row.next()) return std::optional(static_cast<StoredState>(row.integer(0)));
    if (core::Status status = row.status(); !status) return status.error();
    return std::optional<StoredState>();
  }

  core::Result<std::vector<StoredSpec>> specs(uint64_t after, uint64_t most_bytes) override {
    const core::MutexLock lock(mutex_);
    Query rows = query(
        "SELECT job, spec FROM specs WHERE job > ? AND job IN (SELECT id FROM jobs) "
        "ORDER BY job LIMIT ?");
    rows.bind(number(after)).bind(int64_t{kRowsAtOnce});
    std::vector<StoredSpec> specs;
    for (uint64_t bytes = 0; (specs.empty() || bytes < most_bytes) && rows.next();) {
      specs.push_back({static_cast<uint64_t>(rows.integer(0)), rows.bytes(1)});
      bytes += specs.back().spec.size();
    }
    if (core::Status status = rows.status(); !status) return status.error();
    return specs;
  }

  core::Result<std::vector<StoredJob>> list(bool ended, const std::string& owner, uint64_t before,
                                            uint32_t limit) override {
    const core::MutexLock lock(mutex_);
    // Without those that have ended the partial index does the work.
    Query rows(db_.get(), "SELECT " + std::string(kJobColumns) + " FROM jobs WHERE id < ?" +
                              (ended ? "" : " AND state < 3") +
                              (owner.empty() ? "" : " AND owner = ?") +
                              " ORDER BY id DESC LIMIT ?");
    rows.bind(before == 0 ? INT64_MAX : number(before));
    if (!owner.empty()) rows.bind(owner);
    rows.bind(int64_t{limit});
    std::vector<StoredJob> jobs;
    while (rows.next()) jobs.push_back(read_job(rows));
    if (core::Status status = rows.status(); !status) return status.error();
    return jobs;
  }

  core::Result<uint64_t> core_ns_of(const std::string& owner, int64_t since_ms) override {
    const core::MutexLock lock(mutex_);
    Query sum(db_.get(), "SELECT SUM(core_ns) FROM core_time WHERE owner = ? AND hour >= ?");
    sum.bind(owner).bind(since_ms / kMsPerHour);
    const uint64_t total = sum.next() ? static_cast<uint64_t>(sum.integer(0)) : 0;
    if (core::Status status = sum.status(); !status) return status.error();
    return total;
  }

  core::Status frame_over(uint64_t job, const StoredFrame& frame,
                          const std::vector<StoredOutput>& outputs) override {
    core::Status stored = at_once([&]() HYADES_REQUIRES(mutex_) {
      if (looking_ > 0 && !frame.parts.empty()) stored_meanwhile_.push_back({job, frame.frame});
      core::Status done = put_frame(db_.get(), job, frame);
      return done ? put_outputs(db_.get(), job, outputs) : done;
    });
    if (stored) reserve_.keep();
    return stored;
  }

  core::Status change_outputs(uint64_t job, const std::vector<std::string>& gone,
                              const std::vector<StoredOutput>& made) override {
    return at_once([&]() HYADES_REQUIRES(mutex_) {
      core::Status done = delete_outputs(db_.get(), job, gone);
      return done ? put_outputs(db_.get(), job, made) : done;
    });
  }

  core::Status forget_frames(uint64_t job, std::span<const int32_t> frames) override {
    return at_once([&]() HYADES_REQUIRES(mutex_) {
      core::Status done;
      for (size_t i = 0; done && i < frames.size(); ++i)
        done = delete_frame(db_.get(), job, frames[i]);
      return done;
    });
  }

  core::Status forget_failed_frames(uint64_t job) override {
    std::optional<int32_t> after;
    for (bool more = true; more; let_others()) {
      const core::Status done = at_once([&]() HYADES_REQUIRES(mutex_) -> core::Status {
        const auto gone = delete_failed_frames(db_.get(), job, after, kRowsAtOnce);
        more = gone && *gone;
        return gone ? core::Status() : gone.error();
      });
      if (!done) return done;
    }
    return {};
  }

  using JobStore::frames;
  core::Result<std::vector<StoredFrame>> frames(uint64_t job, std::optional<int32_t> after,
                                                uint32_t limit) override {
    return in_pages<StoredFrame>(
        limit, [&](const StoredFrame* last, uint32_t most) HYADES_REQUIRES(mutex_) {
          return read_frames(db_.get(), job, last ? std::optional(last->frame) : after, most);
        });
  }

  core::Result<std::vector<StoredOutput>> outputs(uint64_t job, uint64_t after,
                                                  uint32_t limit) override {
    return in_pages<StoredOutput>(
        limit, [&](const StoredOutput* last, uint32_t most) HYADES_REQUIRES(mutex_) {
          return read_outputs(db_.get(), job, last ? last->number : after, most);
        });
  }

  core::Result<std::vector<StoredOutput>> outputs_of(uint64_t job, int32_t frame) override {
    const core::MutexLock lock(mutex_);
    return read_outputs_of(db_.get(), job, frame);
  }

  core::Result<std::optional<StoredOutput>> output(uint64_t job, const std::string& path) override {
    const core::MutexLock lock(mutex_);
    return read_output(db_.get(), job, path);
  }

  core::Status quarantine(const StoredQuarantine& worker) override {
    const core::MutexLock lock(mutex_);
    return put_quarantine(worker);
  }

  core::Status end_quarantine(const std::string& worker) override {
    const core::MutexLock lock(mutex_);
    return query("DELETE FROM quarantines WHERE worker = ?").bind(worker).run();
  }

  core::Result<std::vector<StoredQuarantine>> quarantines() override {
    const core::MutexLock lock(mutex_);
    std::vector<StoredQuarantine> workers;
    Query rows(db_.get(), "SELECT worker, reason FROM quarantines ORDER BY worker");
    while (rows.next()) workers.push_back({rows.bytes(0), rows.bytes(1)});
    if (core::Status status = rows.status(); !status) return status.error();
    return workers;
  }

  core::Status trust(const std::vector<StoredTrust>& workers) override {
    const core::MutexLock lock(mutex_);
    return store_trust(db_.get(), workers);
  }

  core::Result<std::vector<StoredTrust>> trusted() override {
    const core::MutexLock lock(mutex_);
    return read_trust(db_.get());
  }

  core::Result<std::vector<SuspectFrames>> mark_divergent(const StoredQuarantine& worker,
                                                          uint64_t since,
                                                          const StoredLine& line) override {
    std::vector<FrameOfJob> found;
    const LookingThrough frames(*this);
    if (core::Status looked = look_through(worker.worker, since, found); !looked) {
      return looked.error();
    }
    std::vector<SuspectFrames> suspects;
    const core::Status stored = at_once([&]() HYADES_REQUIRES(mutex_) -> core::Status {
      if (core::Status kept = put_quarantine(worker); !kept) return kept;
      found.insert(found.end(), stored_meanwhile_.begin(), stored_meanwhile_.end());
      auto jobs = make_suspect(db_.get(), worker.worker, since, std::move(found));
      if (!jobs) return jobs.error();
      suspects = std::move(*jobs);
      for (const SuspectFrames& job : suspects) {
        StoredLine told = line;
        told.text += tell_frames(job.frames);
        if (core::Status added = lines_.add(db_.get(), job.job, {told}); !added) return added;
      }
      return {};
    });
    if (!stored) return stored.error();
    return suspects;
  }

  core::Result<std::vector<int32_t>> suspect_frames(uint64_t job, uint32_t limit) override {
    const core::MutexLock lock(mutex_);
    return read_suspect_frames(db_.get(), job, limit);
  }
  core::Result<std::vector<int32_t>> black(uint64_t job, uint32_t limit) override {
    const core::MutexLock lock(mutex_);
    return read_black(db_.get(), job, limit);
  }

  core::Status add_lines(uint64_t job, const std::vector<StoredLine>& lines) override {
    return at_once([&]() HYADES_REQUIRES(mutex_) { return lines_.add(db_.get(), job, lines); });
  }

  core::Result<std::vector<StoredLine>> lines(uint64_t job, uint64_t after,
                                              uint32_t limit) override {
    const core::MutexLock lock(mutex_);
    return read_lines(db_.get(), job, after, limit);
  }

  core::Result<std::vector<StoredToken>> tokens() override {
    const core::MutexLock lock(mutex_);
    return read_tokens(db_.get());
  }
  core::Status add_token(const StoredToken& token) override {
    return with_reserve([&] {
      const core::MutexLock lock(mutex_);
      return insert_token(db_.get(), token);
    });
  }
  core::Status revoke_token(const std::string& id, int64_t revoked_ms) override {
    return with_reserve([&] {
      const core::MutexLock lock(mutex_);
      return mark_revoked(db_.get(), id, revoked_ms);
    });
  }
  core::Status forget_token(const std::string& id) override {
    const core::MutexLock lock(mutex_);
    return query("DELETE FROM tokens WHERE id = ?").bind(id).run();
  }
  core::Status note_uses(const std::vector<TokenUse>& uses) override {
    const core::MutexLock lock(mutex_);
    return update_uses(db_.get(), uses);
  }

 private:
  core::Result<std::optional<uint64_t>> find_key(const std::string& key) HYADES_REQUIRES(mutex_) {
    Query known = query("SELECT id FROM jobs WHERE key = ?");  // none has the empty one
    known.bind(key);
    if (known.next()) return std::optional(static_cast<uint64_t>(known.integer(0)));
    if (core::Status status = known.status(); !status) return status.error();
    return std::optional<uint64_t>();
  }

  core::Result<std::optional<StoredJob>> find_job(uint64_t id) HYADES_REQUIRES(mutex_) {
    Query row = query("SELECT " + std::string(kJobColumns) + " FROM jobs WHERE id = ?");
    row.bind(number(id));
    if (row.next()) return std::optional(read_job(row));
    if (core::Status status = row.status(); !status) return status.error();
    return std::optional<StoredJob>();
  }

  core::Status put_quarantine(const StoredQuarantine& worker) HYADES_REQUIRES(mutex_) {
    return query("INSERT OR REPLACE INTO quarantines (worker, reason) VALUES (?, ?)")
        .bind(worker.worker)
        .bind(worker.reason)
        .run();
  }

  /// What has to be stored on a full disk too, as it makes room: the ends of jobs.
  core::Status with_reserve(const std::function<core::Status()>& what) {
    core::Status done = what();
    if (!done && reserve_.release()) done = what();
    if (done) reserve_.keep();
    return done;
  }

  /// All of `what` in one transaction, or nothing.
  core::Status at_once(const std::function<core::Status()>& what) {
    const core::MutexLock lock(mutex_);
    Transaction transaction(db_.get());
    if (core::Status begun = transaction.status(); !begun) return begun;
    core::Status done = what();
    if (done) done = transaction.commit();
    if (!done) lines_.forget_counts();
    return done;
  }

  /// Between two pieces of what is long: who waits for the lock is slower than whoever has just let
  /// it go.
  static void let_others() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

  /// At most `limit` rows, in pages that `read(last, most)` reads: those after the `last` one
  /// (null: the first ones), at most `most`.
  template <class Row, class Read>
  core::Result<std::vector<Row>> in_pages(uint32_t limit, const Read& read) {
    std::vector<Row> all;
    for (;; let_others()) {
      const auto left = static_cast<uint32_t>(limit - all.size());
      const uint32_t most = std::min(left, kRowsAtOnce);
      core::MutexLock lock(mutex_);
      core::Result<std::vector<Row>> page = read(all.empty() ? nullptr : &all.back(), most);
      lock.unlock();
      if (!page) return page;
      std::move(page->begin(), page->end(), std::back_inserter(all));
      if (page->size() < most || most == left) return all;
    }
  }

  /// While it lives the finished frames that are stored are noted.
  class LookingThrough {
   public:
    explicit LookingThrough(SqliteJobStore& store) : store_(store) {
      const core::MutexLock lock(store_.mutex_);
      ++store_.looking_;
    }
    ~LookingThrough() {
      const core::MutexLock lock(store_.mutex_);
      if (--store_.looking_ == 0) store_.stored_meanwhile_ = {};
    }
    LookingThrough(const LookingThrough&) = delete;
    LookingThrough& operator=(const LookingThrough&) = delete;

   private:
    SqliteJobStore& store_;
  };

  /// Finds the frames that the worker had a part in; others have their turns.
  core::Status look_through(const std::string& worker, uint64_t since,
                            std::vector<FrameOfJob>& found) {
    FrameOfJob last;
    for (bool more = true; more; let_others()) {
      const core::MutexLock lock(mutex_);
      const auto page = find_frames_of(db_.get(), worker, since, last, kRowsAtOnce, found);
      if (!page) return page.error();
      more = *page;
    }
    return {};
  }

  /// Short-lived: SQLite prepares such statements in some ten microseconds.
  Query query(std::string_view sql) HYADES_REQUIRES(mutex_) { return {db_.get(), sql}; }

  static void bind_changing(Query& query, const StoredJob& job) {
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

  core::Mutex mutex_;
  Database db_ HYADES_GUARDED_BY(mutex_);
  const std::string starts_;
  ReserveFile reserve_;
  LogRows lines_ HYADES_GUARDED_BY(mutex_);
  int looking_ HYADES_GUARDED_BY(mutex_) = 0;  ///< how many look through all finished frames
  std::vector<FrameOfJob> stored_meanwhile_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace

core::Result<std::unique_ptr<JobStore>> open_sqlite_job_store(const std::string& path) {
  auto db = open_database(path);
  // To bring it to this schema takes some room.
  if (!db && ReserveFile(path + ".reserve", kReserve).release()) db = open_database(path);
  if (!db) return db.error();
  return std::unique_ptr<JobStore>(std::make_unique<SqliteJobStore>(std::move(*db), path));
}

}  // namespace hyades::coordinator
