#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/job_store/job_store.h"

namespace hyades::coordinator {

/// What goes wrong with a TroubledStore, for the test to say; shared with the store.
class Trouble {
 public:
  enum class Kind { none, fails, waits };
  /// What becomes of calls that write, and of those that read.
  void of_writes(Kind kind) { set(writes_, kind); }
  void of_reads(Kind kind) { set(reads_, kind); }
  /// What becomes of reading the frames of a job, all its outputs, or its state, alone.
  void of_frames(Kind kind) { set(frames_, kind); }
  void of_outputs(Kind kind) { set(outputs_, kind); }
  void of_states(Kind kind) { set(states_, kind); }
  /// How many calls wait.
  int waiting() const {
    const std::lock_guard lock(mutex_);
    return waiting_;
  }

  /// What becomes of dropping rows of removed jobs, alone.
  void of_drops(Kind kind) { set(drops_, kind); }
  /// How many calls were waiting at once at most.
  int most_waiting() const {
    const std::lock_guard lock(mutex_);
    return most_waiting_;
  }

  /// How often it was looked what jobs ask for.
  int looks() const { return looks_; }
  void count_look() { ++looks_; }

  /// How many calls have failed.
  int failed() const {
    const std::lock_guard lock(mutex_);
    return failed_;
  }

  core::Status write() { return pass(writes_); }
  core::Status read() { return pass(reads_); }
  core::Status read_frames() { return pass(frames_); }
  core::Status read_outputs() { return pass(outputs_); }
  core::Status read_state() { return pass(states_); }
  core::Status drop() { return pass(drops_); }

 private:
  void set(Kind& which, Kind kind) {
    const std::lock_guard lock(mutex_);
    which = kind;
    wake_.notify_all();
  }
  core::Status pass(const Kind& kind) {
    std::unique_lock lock(mutex_);
    most_waiting_ = std::max(most_waiting_, ++waiting_);
    wake_.wait(lock, [&] { return kind != Kind::waits; });
    --waiting_;
    if (kind != Kind::fails) return {};
    ++failed_;
    return core::Error{"the job store: database or disk is full"};
  }

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  Kind writes_ = Kind::none;
  Kind reads_ = Kind::none;
  Kind frames_ = Kind::none;
  Kind outputs_ = Kind::none;
  Kind states_ = Kind::none;
  Kind drops_ = Kind::none;
  std::atomic<int> looks_{0};
  int waiting_ = 0;
  int most_waiting_ = 0;
  int failed_ = 0;
};

/// A job store whose disk fails or does not answer when a test wants it.
class TroubledStore final : public JobStore {
 public:
  TroubledStore(std::unique_ptr<JobStore> store, std::shared_ptr<Trouble> trouble)
      : store_(std::move(store)), trouble_(std::move(trouble)) {}

  core::Result<uint64_t> next_incarnation() override { return store_->next_incarnation(); }
  core::Result<Added> add_job(const StoredJob& job) override {
    return written([&] { return store_->add_job(job); });
  }
  core::Result<std::optional<uint64_t>> job_of_key(const std::string& key) override {
    return read([&] { return store_->job_of_key(key); });
  }
  core::Status update_job(const StoredJob& job) override {
    return written([&] { return store_->update_job(job); });
  }
  core::Status remove_job(uint64_t id) override {
    return written([&] { return store_->remove_job(id); });
  }
  core::Result<bool> drop_removed(uint32_t rows) override {
    if (core::Status passed = trouble_->drop(); !passed) return passed.error();
    return written([&] { return store_->drop_removed(rows); });
  }
  core::Result<std::vector<uint64_t>> open_jobs() override { return store_->open_jobs(); }
  core::Result<std::optional<StoredJob>> job(uint64_t id) override {
    return read([&] { return store_->job(id); });
  }
  core::Result<std::optional<StoredJob>> summary(uint64_t id) override {
    return read([&] { return store_->summary(id); });
  }
  core::Result<std::optional<StoredState>> state(uint64_t id) override {
    if (core::Status passed = trouble_->read_state(); !passed) return passed.error();
    return read([&] { return store_->state(id); });
  }
  core::Result<std::vector<StoredSpec>> specs(uint64_t after, uint64_t most_bytes) override {
    trouble_->count_look();
    return read([&] { return store_->specs(after, most_bytes); });
  }
  core::Result<std::vector<StoredJob>> list(bool ended, const std::string& owner, uint64_t before,
                                            uint32_t limit) override {
    return read([&] { return store_->list(ended, owner, before, limit); });
  }
  core::Result<uint64_t> core_ns_of(const std::string& owner, int64_t since_ms) override {
    return read([&] { return store_->core_ns_of(owner, since_ms); });
  }
  core::Status frame_over(uint64_t job, const StoredFrame& frame,
                          const std::vector<StoredOutput>& outputs) override {
    return written([&] { return store_->frame_over(job, frame, outputs); });
  }
  core::Status change_outputs(uint64_t job, const std::vector<std::string>& gone,
                              const std::vector<StoredOutput>& made) override {
    return written([&] { return store_->change_outputs(job, gone, made); });
  }
  core::Status forget_frames(uint64_t job, std::span<const int32_t> frames) override {
    return written([&] { return store_->forget_frames(job, frames); });
  }
  core::Status forget_failed_frames(uint64_t job) override {
    return written([&] { return store_->forget_failed_frames(job); });
  }
  using JobStore::frames;
  core::Result<std::vector<StoredFrame>> frames(uint64_t job, std::optional<int32_t> after,
                                                uint32_t limit) override {
    if (core::Status passed = trouble_->read_frames(); !passed) return passed.error();
    return read([&] { return store_->frames(job, after, limit); });
  }
  core::Result<std::vector<StoredOutput>> outputs(uint64_t job, uint64_t after,
                                                  uint32_t limit) override {
    if (core::Status passed = trouble_->read_outputs(); !passed) return passed.error();
    return read([&] { return store_->outputs(job, after, limit); });
  }
  core::Result<std::vector<StoredOutput>> outputs_of(uint64_t job, int32_t frame) override {
    return read([&] { return store_->outputs_of(job, frame); });
  }
  core::Result<std::optional<StoredOutput>> output(uint64_t job, const std::string& path) override {
    return read([&] { return store_->output(job, path); });
  }
  core::Result<std::string> secret() override { return store_->secret(); }
  core::Status quarantine(const StoredQuarantine& worker) override {
    return written([&] { return store_->quarantine(worker); });
  }
  core::Status end_quarantine(const std::string& worker) override {
    return written([&] { return store_->end_quarantine(worker); });
  }
  core::Result<std::vector<StoredQuarantine>> quarantines() override {
    return store_->quarantines();
  }
  core::Status trust(const std::vector<StoredTrust>& workers) override {
    return written([&] { return store_->trust(workers); });
  }
  core::Result<std::vector<StoredTrust>> trusted() override { return store_->trusted(); }
  core::Result<std::vector<SuspectFrames>> mark_divergent(const StoredQuarantine& worker,
                                                          uint64_t since,
                                                          const StoredLine& line) override {
    return written([&] { return store_->mark_divergent(worker, since, line); });
  }
  core::Result<std::vector<int32_t>> suspect_frames(uint64_t job, uint32_t limit) override {
    return read([&] { return store_->suspect_frames(job, limit); });
  }
  core::Result<std::vector<int32_t>> black(uint64_t job, uint32_t limit) override {
    return read([&] { return store_->black(job, limit); });
  }
  core::Result<std::vector<StoredToken>> tokens() override { return store_->tokens(); }
  core::Status add_token(const StoredToken& token) override {
    return written([&] { return store_->add_token(token); });
  }
  core::Status revoke_token(const std::string& id, int64_t revoked_ms) override {
    return written([&] { return store_->revoke_token(id, revoked_ms); });
  }
  core::Status forget_token(const std::string& id) override {
    return written([&] { return store_->forget_token(id); });
  }
  core::Status note_uses(const std::vector<TokenUse>& uses) override {
    return written([&] { return store_->note_uses(uses); });
  }
  core::Status add_lines(uint64_t job, const std::vector<StoredLine>& lines) override {
    return written([&] { return store_->add_lines(job, lines); });
  }
  core::Result<std::vector<StoredLine>> lines(uint64_t job, uint64_t after,
                                              uint32_t limit) override {
    return read([&] { return store_->lines(job, after, limit); });
  }

 private:
  template <class What>
  auto written(const What& what) -> decltype(what()) {
    if (core::Status passed = trouble_->write(); !passed) return passed.error();
    return what();
  }
  template <class What>
  auto read(const What& what) -> decltype(what()) {
    if (core::Status passed = trouble_->read(); !passed) return passed.error();
    return what();
  }

  const std::unique_ptr<JobStore> store_;
  const std::shared_ptr<Trouble> trouble_;
};

}  // namespace hyades::coordinator
