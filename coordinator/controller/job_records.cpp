#include "coordinator/controller/job_records.h"

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/job_queries.h"
#include "coordinator/controller/watchers.h"
#include "core/base/text.h"
#include "core/base/wall_clock.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

/// After this somebody who waits for a change to be stored is told to come again.
constexpr Duration kStorePatience = std::chrono::milliseconds(500);
constexpr int kMostTries = 20;  ///< to store the last lines of a job that has ended
constexpr Duration kLinesAgain = std::chrono::seconds(1);
/// How far the account of a job may lag behind in the store: so much of it is lost in a crash.
constexpr Duration kStoreAccountEvery = std::chrono::seconds(10);

grpc::Status not_stored(const std::string& why) {
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                           "it is so now, but not stored yet" + (why.empty() ? why : ": " + why),
                           std::chrono::seconds(1));
}

}  // namespace

void JobRecords::when_stored(uint64_t job, JobReply then) { wait(job, false, std::move(then)); }

void JobRecords::when_done(uint64_t key, JobReply then) {
  const ActiveJob* active = jobs_.find(key);
  context_.background.add(
      key,
      [this, key, number = next_reply_] {
        answer(key, number);
        return true;
      },
      active != nullptr ? active->stored.owner : std::string());
  wait(key, true, std::move(then));
}

void JobRecords::wait(uint64_t key, bool for_tasks, JobReply then) {
  const TimePoint give_up = std::chrono::steady_clock::now() + kStorePatience;
  replies_.push_back({next_reply_++, key, for_tasks, give_up, std::move(then)});
}

void JobRecords::answer(uint64_t key, uint64_t number) {
  std::vector<PendingReply> told;
  v1::Job now;
  {
    const StateLock lock(context_.mutex);
    if (const ActiveJob* active = jobs_.find(key)) now = queries_.describe(*active);
    told = take_replies([&](const PendingReply& r) { return r.number == number; });
  }
  for (const PendingReply& reply : told) reply.then(grpc::Status::OK, now);
}

void JobRecords::store(ActiveJob& active) {
  if (std::exchange(active.storing_row, true)) return;
  context_.in_background(active, [this, id = active.stored.id] { return store_now(id); });
}

bool JobRecords::store_now(uint64_t id) {
  StoredJob job;
  uint64_t before = 0;
  {
    const StateLock lock(context_.mutex);
    ActiveJob* active = jobs_.find(id);
    if (active == nullptr || active->ending) return true;  // its end will be stored
    active->storing_row = false;
    job = active->stored;
    before = next_reply_;
  }
  const core::Status done = context_.store->update_job(job);
  std::vector<PendingReply> told;
  v1::Job now;
  {
    const StateLock lock(context_.mutex);
    ActiveJob* active = jobs_.find(id);
    if (active == nullptr) return true;
    if (!done) {
      active->storing_row = true;
      active->row_trouble = "a change cannot be stored: " + done.error().message;
      active->touch();
      return false;
    }
    active->account_is_stored(job);
    if (!active->row_trouble.empty()) active->touch();
    active->row_trouble.clear();
    now = queries_.describe(*active);
    told = take_replies(
        [&](const PendingReply& r) { return r.job == id && !r.for_tasks && r.number < before; });
  }
  for (const PendingReply& reply : told) reply.then(grpc::Status::OK, now);
  return true;
}

std::vector<JobRecords::PendingReply> JobRecords::take_replies(
    const std::function<bool(const PendingReply&)>& which) {
  std::vector<PendingReply> taken;
  std::erase_if(replies_, [&](PendingReply& reply) {
    if (!which(reply)) return false;
    taken.push_back(std::move(reply));
    return true;
  });
  return taken;
}

void JobRecords::answer_late(TimePoint now) {
  std::vector<std::pair<PendingReply, std::string>> late;
  {
    const StateLock lock(context_.mutex);
    for (PendingReply& reply :
         take_replies([&](const PendingReply& r) { return context_.stop || r.give_up <= now; })) {
      const ActiveJob* active = jobs_.find(reply.job);
      late.emplace_back(std::move(reply), active != nullptr ? active->row_trouble : std::string());
    }
  }
  for (const auto& [reply, why] : late) reply.then(not_stored(why), {});
}

void JobRecords::look_after(TimePoint now, bool disk_full, const Scheduler& scheduler) {
  for (const auto& [id, active] : jobs_.all()) {
    const uint32_t leased = scheduler.leased_units(id);
    active->speed.note(active->samples_done, now, leased > 0);
    active->set_busy(active->is_worked_on(leased), now);
    if (active->ending || disk_full) continue;
    if (active->account_has_grown() && now - active->account_stored >= kStoreAccountEvery) {
      active->account_stored = now;
      store(*active);
    }
    if (!active->log.begin_storing(now)) continue;
    context_.in_background(*active, [this, id = active->id] { return store_lines(id); });
  }
}

void JobRecords::store_accounts(TimePoint now) {
  std::vector<StoredJob> rows;
  {
    const StateLock lock(context_.mutex);
    for (const auto& [id, active] : jobs_.all()) {
      // An end that is not stored yet comes again by itself after the next start.
      if (active->ending) continue;
      active->set_busy(false, now);
      if (active->account_has_grown()) rows.push_back(active->stored);
    }
  }
  // On a full disk what has come since the last time is lost, as in a crash.
  for (const StoredJob& row : rows) (void)context_.store->update_job(row);
}

/// Where they cannot be stored they wait in memory, and hold up none of the job's tasks.
bool JobRecords::store_lines(JobId id) {
  std::vector<StoredLine> lines;
  {
    const StateLock lock(context_.mutex);
    ActiveJob* active = jobs_.find(id);
    if (active == nullptr) return true;
    if (!active->log.empty()) lines = active->log.take();
  }
  const core::Status stored = context_.store->add_lines(static_cast<uint64_t>(id), lines);
  const StateLock lock(context_.mutex);
  ActiveJob* still = jobs_.find(id);
  if (still == nullptr) return true;
  if (stored) {
    still->log.stored();
  } else {
    still->log.not_stored(std::move(lines), std::chrono::steady_clock::now() + kLinesAgain);
  }
  return true;
}

void JobRecords::end(ActiveJob& active, bool cancelled, const std::string& why) {
  active.set_busy(false, std::chrono::steady_clock::now());
  active.ending = true;
  StoredJob& stored = active.stored;
  stored.state = cancelled                                  ? StoredState::cancelled
                 : stored.frames_failed > 0 || !why.empty() ? StoredState::failed
                                                            : StoredState::done;
  stored.ended_ms = core::wall_ms();
  stored.samples_done = active.samples_done;
  stored.reason = farm::wire_text(why);
  if (stored.reason.empty() && !active.failed.empty()) {
    const int32_t first = *active.failed.begin();
    stored.reason = fmt::format("frame {} failed: {}", first, *active.frames.at(first).reason);
  }
  jobs_.note(active, v1::LOG_LEVEL_INFO, std::nullopt, {},
             fmt::format("ended: {} done, {} failed{}", core::counted(stored.frames_done, "frame"),
                         stored.frames_failed, cancelled ? ", cancelled" : ""));
  context_.in_background(active, [this, id = stored.id] { return store_end(id); });
}

bool JobRecords::store_end(uint64_t id) {
  StoredJob job;
  {
    const StateLock lock(context_.mutex);
    job = jobs_.find(id)->stored;
  }
  // The end first: on a full disk there may be room for it alone.
  const core::Status done = context_.store->update_job(job);
  std::vector<StoredLine> lines;
  {
    const StateLock lock(context_.mutex);
    ActiveJob* over = jobs_.find(id);
    if (!done) {
      over->row_trouble = "its end cannot be stored: " + done.error().message;
      over->touch();
      return false;
    }
    lines = over->log.take();
  }
  if (!lines.empty() && !context_.store->add_lines(id, lines)) {
    // The job is over for whoever waits for it; its last words come as long as there is hope.
    context_.background.add(
        id,
        [this, id, lines = std::move(lines), tries = 0]() mutable {
          const auto still = context_.store->state(id);
          const bool deleted = still && !*still;
          return deleted || context_.store->add_lines(id, lines).ok() || ++tries == kMostTries;
        },
        job.owner);
  }
  std::shared_ptr<ActiveJob> over;
  std::vector<PendingReply> told;
  {
    const StateLock lock(context_.mutex);
    over = jobs_.take_out(id);
    told = take_replies([&](const PendingReply& reply) { return reply.job == id; });
    watchers_.poke(id);
  }
  for (const PendingReply& reply : told) reply.then(grpc::Status::OK, queries_.describe(job));
  context_.closing.add(
      id,
      [this, id, done = job.state == StoredState::done, over = std::move(over)]() mutable {
        over.reset();  // waits for the film store's thread
        // Films of frames that failed stay, should they be retried.
        if (done) context_.films->remove(id, UINT64_MAX);
        jobs_.left(id);
        return true;
      },
      job.owner);
  return true;
}

}  // namespace hyades::coordinator
