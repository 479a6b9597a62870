#include "coordinator/job_store/sql_job_store.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "coordinator/job_store/contributor_rows.h"
#include "coordinator/job_store/frame_rows.h"
#include "coordinator/job_store/job_rows.h"
#include "coordinator/job_store/log_rows.h"
#include "coordinator/job_store/output_rows.h"
#include "coordinator/job_store/quarantine_rows.h"
#include "coordinator/job_store/removals.h"
#include "coordinator/job_store/token_rows.h"
#include "core/base/mutex.h"

namespace hyades::coordinator {
namespace {

core::Result<std::string> read_secret(SqlConnection& db) {
  Query found(db, "SELECT text FROM secret");
  std::string text = found.next() ? found.bytes(0) : std::string();
  if (core::Status read = found.status(); !read) return read.error();
  if (text.empty()) return core::Error{"the store has lost its secret"};
  return text;
}

class SqlJobStore final : public JobStore {
 public:
  explicit SqlJobStore(SqlJobStoreParts parts)
      : db_(std::move(parts.db)),
        next_incarnation_(std::move(parts.next_incarnation)),
        reserve_(std::move(parts.reserve)),
        old_columns_(parts.old_columns) {
    keep_reserve();
  }

  core::Result<uint64_t> next_incarnation() override {
    auto counted = locked(next_incarnation_);
    if (!counted && release_reserve()) counted = locked(next_incarnation_);
    return counted;
  }

  core::Result<std::string> secret() override { return locked(read_secret); }

  core::Result<Added> add_job(const StoredJob& job) override {
    Added added;
    const core::Status done = at_once([&]() HYADES_REQUIRES(mutex_) -> core::Status {
      const auto known = find_key(*db_, job.key);
      if (!known) return known.error();
      if (*known) {
        added = {**known, true};
        return {};
      }
      const auto id = insert_job(*db_, job, old_columns_);
      if (!id) return id.error();
      added.id = *id;
      return {};
    });
    if (!done) return done.error();
    if (!added.existed) keep_reserve();
    return added;
  }

  core::Result<std::optional<uint64_t>> job_of_key(const std::string& key) override {
    return locked(find_key, key);
  }

  core::Status update_job(const StoredJob& job) override {
    return with_reserve([&] { return locked(update_job_row, job); });
  }

  core::Status remove_job(uint64_t id) override {
    return with_reserve([&] {
      const core::MutexLock lock(mutex_);
      lines_.forget_counts();
      return mark_removed(*db_, id);
    });
  }

  core::Result<bool> drop_removed(uint32_t rows) override {
    return locked(drop_removed_rows, rows);
  }

  core::Result<std::vector<uint64_t>> open_jobs() override { return locked(read_open_jobs); }

  core::Result<std::optional<StoredJob>> job(uint64_t id) override { return locked(read_job, id); }

  core::Result<std::optional<StoredJob>> summary(uint64_t id) override {
    return locked(read_summary, id);
  }

  core::Result<std::optional<StoredState>> state(uint64_t id) override {
    return locked(read_state, id);
  }

  core::Result<std::vector<StoredSpec>> specs(uint64_t after, uint64_t most_bytes) override {
    return locked(read_specs, after, most_bytes);
  }

  core::Result<std::vector<StoredJob>> list(bool ended, const std::string& owner, uint64_t before,
                                            uint32_t limit) override {
    return locked(read_jobs, ended, owner, before, limit);
  }

  core::Result<uint64_t> core_ns_of(const std::string& owner, int64_t since_ms) override {
    return locked(read_core_ns, owner, since_ms);
  }

  core::Status frame_over(uint64_t job, const StoredFrame& frame,
                          const std::vector<StoredOutput>& outputs) override {
    core::Status stored = at_once([&]() HYADES_REQUIRES(mutex_) {
      if (looking_ > 0 && !frame.parts.empty()) stored_meanwhile_.push_back({job, frame.frame});
      core::Status done = put_frame(*db_, job, frame);
      return done ? put_outputs(*db_, job, outputs) : done;
    });
    if (stored) keep_reserve();
    return stored;
  }

  core::Status change_outputs(uint64_t job, const std::vector<std::string>& gone,
                              const std::vector<StoredOutput>& made) override {
    return at_once([&]() HYADES_REQUIRES(mutex_) {
      core::Status done = delete_outputs(*db_, job, gone);
      return done ? put_outputs(*db_, job, made) : done;
    });
  }

  core::Status forget_frames(uint64_t job, std::span<const int32_t> frames) override {
    return at_once([&]() HYADES_REQUIRES(mutex_) {
      core::Status done;
      for (size_t i = 0; done && i < frames.size(); ++i) done = delete_frame(*db_, job, frames[i]);
      return done;
    });
  }

  core::Status forget_failed_frames(uint64_t job) override {
    std::optional<int32_t> after;
    for (bool more = true; more; let_others()) {
      const core::Status done = at_once([&]() HYADES_REQUIRES(mutex_) -> core::Status {
        const auto gone = delete_failed_frames(*db_, job, after, kRowsAtOnce);
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
    return in_pages<StoredFrame>(limit, [&](const StoredFrame* last, uint32_t most) {
      return locked(read_frames, job, last ? std::optional(last->frame) : after, most);
    });
  }

  core::Result<std::vector<StoredOutput>> outputs(uint64_t job, uint64_t after,
                                                  uint32_t limit) override {
    return in_pages<StoredOutput>(limit, [&](const StoredOutput* last, uint32_t most) {
      return locked(read_outputs, job, last ? last->number : after, most);
    });
  }

  core::Result<std::vector<StoredOutput>> outputs_of(uint64_t job, int32_t frame) override {
    return locked(read_outputs_of, job, frame);
  }

  core::Result<std::optional<StoredOutput>> output(uint64_t job, const std::string& path) override {
    return locked(read_output, job, path);
  }

  core::Status quarantine(const StoredQuarantine& worker) override {
    return locked(put_quarantine, worker);
  }
  core::Status end_quarantine(const std::string& worker) override {
    return locked(delete_quarantine, worker);
  }
  core::Result<std::vector<StoredQuarantine>> quarantines() override {
    return locked(read_quarantines);
  }

  core::Status trust(const std::vector<StoredTrust>& workers) override {
    return locked(store_trust, workers);
  }
  core::Result<std::vector<StoredTrust>> trusted() override { return locked(read_trust); }

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
      if (core::Status kept = put_quarantine(*db_, worker); !kept) return kept;
      found.insert(found.end(), stored_meanwhile_.begin(), stored_meanwhile_.end());
      auto jobs = make_suspect(*db_, worker.worker, since, std::move(found));
      if (!jobs) return jobs.error();
      suspects = std::move(*jobs);
      for (const SuspectFrames& job : suspects) {
        StoredLine told = line;
        told.text += tell_frames(job.frames);
        if (core::Status added = lines_.add(*db_, job.job, {told}); !added) return added;
      }
      return {};
    });
    if (!stored) return stored.error();
    return suspects;
  }

  core::Result<std::vector<int32_t>> suspect_frames(uint64_t job, uint32_t limit) override {
    return locked(read_suspect_frames, job, limit);
  }
  core::Result<std::vector<int32_t>> black(uint64_t job, uint32_t limit) override {
    return locked(read_black, job, limit);
  }

  core::Status add_lines(uint64_t job, const std::vector<StoredLine>& lines) override {
    return at_once([&]() HYADES_REQUIRES(mutex_) { return lines_.add(*db_, job, lines); },
                   Durability::lagging);
  }
  core::Result<std::vector<StoredLine>> lines(uint64_t job, uint64_t after,
                                              uint32_t limit) override {
    return locked(read_lines, job, after, limit);
  }

  core::Result<std::vector<StoredToken>> tokens() override { return locked(read_tokens); }
  core::Status add_token(const StoredToken& token) override {
    return with_reserve([&] { return locked(insert_token, token); });
  }
  core::Status revoke_token(const std::string& id, int64_t revoked_ms) override {
    return with_reserve([&] { return locked(mark_revoked, id, revoked_ms); });
  }
  core::Status forget_token(const std::string& id) override { return locked(delete_token, id); }
  core::Status note_uses(const std::vector<TokenUse>& uses) override {
    return locked(update_uses, uses);
  }

 private:
  /// What `function` of the rows says, which nobody else reads or changes meanwhile.
  template <class Function, class... Arguments>
  std::invoke_result_t<const Function&, SqlConnection&, const Arguments&...> locked(
      const Function& function, const Arguments&... arguments) {
    const core::MutexLock lock(mutex_);
    return function(*db_, arguments...);
  }

  /// All of `what` in one transaction, or nothing.
  core::Status at_once(const std::function<core::Status()>& what,
                       Durability durability = Durability::durable) {
    const core::MutexLock lock(mutex_);
    Transaction transaction(*db_, durability);
    if (core::Status begun = transaction.status(); !begun) return begun;
    core::Status done = what();
    if (done) done = transaction.commit();
    if (!done) lines_.forget_counts();
    return done;
  }

  void keep_reserve() {
    if (reserve_) reserve_->keep();
  }
  bool release_reserve() { return reserve_ && reserve_->release(); }

  /// What has to be stored on a full disk too, as it makes room: the ends of jobs.
  core::Status with_reserve(const std::function<core::Status()>& what) {
    core::Status done = what();
    if (!done && release_reserve()) done = what();
    if (done) keep_reserve();
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
      core::Result<std::vector<Row>> page = read(all.empty() ? nullptr : &all.back(), most);
      if (!page) return page;
      std::move(page->begin(), page->end(), std::back_inserter(all));
      if (page->size() < most || most == left) return all;
    }
  }

  /// While it lives the finished frames that are stored are noted.
  class LookingThrough {
   public:
    explicit LookingThrough(SqlJobStore& store) : store_(store) {
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
    SqlJobStore& store_;
  };

  /// Finds the frames that the worker had a part in; others have their turns.
  core::Status look_through(const std::string& worker, uint64_t since,
                            std::vector<FrameOfJob>& found) {
    FrameOfJob last;
    for (bool more = true; more; let_others()) {
      const core::MutexLock lock(mutex_);
      const auto page = find_frames_of(*db_, worker, since, last, kRowsAtOnce, found);
      if (!page) return page.error();
      more = *page;
    }
    return {};
  }

  core::Mutex mutex_;
  const std::unique_ptr<SqlConnection> db_ HYADES_GUARDED_BY(mutex_);
  const std::function<core::Result<uint64_t>(SqlConnection&)> next_incarnation_;
  const std::unique_ptr<ReserveFile> reserve_;
  const bool old_columns_;
  LogRows lines_ HYADES_GUARDED_BY(mutex_);
  int looking_ HYADES_GUARDED_BY(mutex_) = 0;  ///< how many look through all finished frames
  std::vector<FrameOfJob> stored_meanwhile_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace

std::unique_ptr<JobStore> make_sql_job_store(SqlJobStoreParts parts) {
  return std::make_unique<SqlJobStore>(std::move(parts));
}

}  // namespace hyades::coordinator
