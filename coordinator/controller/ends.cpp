// What is stored of a job's life, and who waits for that.
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

/// After this somebody who waits for a change to be stored is told to come again.
constexpr Duration kStorePatience = std::chrono::milliseconds(500);
/// For the last lines of a job that has ended; RetryQueue::kAgain apart.
constexpr int kMostTries = 20;

grpc::Status not_stored(const std::string& why) {
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                           "it is so now, but not stored yet" + (why.empty() ? why : ": " + why),
                           std::chrono::seconds(1));
}

}  // namespace

/// `then` is called once the job is stored as it is now, or with the reason why it is not; with the
/// lock.
void Controller::when_stored(uint64_t job, JobReply then) {
  waiters_.push_back(
      {next_waiter_++, job, std::chrono::steady_clock::now() + kStorePatience, std::move(then)});
}

/// Stores what has changed of an open job. All of a job's rows are stored by its tasks, one after
/// the other, and each as the job is then: what is stored last is what was last. With the lock.
void Controller::store_row(ActiveJob& active) {
  if (std::exchange(active.storing_row, true)) return;
  background_.add(active.stored.id, [this, id = active.stored.id] { return store_row_now(id); });
}

bool Controller::store_row_now(uint64_t id) {
  StoredJob job;
  uint64_t before = 0;
  {
    const std::lock_guard lock(mutex_);
    ActiveJob* active = active_job(id);
    if (active == nullptr || active->ending) return true;  // its end will be stored
    active->storing_row = false;
    job = active->stored;
    before = next_waiter_;
  }
  const core::Status done = store_->update_job(job);
  std::vector<Waiter> told;
  v1::Job now;
  {
    const std::lock_guard lock(mutex_);
    ActiveJob* active = active_job(id);
    if (active == nullptr) return true;
    if (!done) {
      active->storing_row = true;
      active->row_trouble = "a change cannot be stored: " + done.error().message;
      active->touch();
      return false;
    }
    active->core_ns_stored = job.core_ns;
    if (!active->row_trouble.empty()) active->touch();
    active->row_trouble.clear();
    now = describe(*active);
    told = take_waiters([&](const Waiter& w) { return w.job == id && w.number < before; });
  }
  for (const Waiter& waiter : told) waiter.then(grpc::Status::OK, now);
  return true;
}

/// With the lock.
std::vector<Controller::Waiter> Controller::take_waiters(
    const std::function<bool(const Waiter&)>& which) {
  std::vector<Waiter> taken;
  std::erase_if(waiters_, [&](Waiter& waiter) {
    if (!which(waiter)) return false;
    taken.push_back(std::move(waiter));
    return true;
  });
  return taken;
}

/// Those who have waited for long enough are let go; without the lock.
void Controller::mind_waiters(TimePoint now) {
  std::vector<std::pair<Waiter, std::string>> late;
  {
    const std::lock_guard lock(mutex_);
    for (Waiter& waiter :
         take_waiters([&](const Waiter& w) { return stop_ || w.give_up <= now; })) {
      const ActiveJob* active = active_job(waiter.job);
      late.emplace_back(std::move(waiter), active != nullptr ? active->row_trouble : std::string());
    }
  }
  for (const auto& [waiter, why] : late) waiter.then(not_stored(why), {});
}

void Controller::job_ended(const JobEnded& ended) {
  const std::lock_guard lock(mutex_);
  ActiveJob* active = active_job(ended.job);
  if (active == nullptr || active->ending) return;
  for (auto& [id, session] : sessions_) {
    if (session.spec_sent.erase(ended.job) == 0) continue;
    v1::CoordinatorMessage message;
    message.mutable_over()->set_job(static_cast<uint64_t>(ended.job));
    send(id, std::move(message));
  }
  active->stored.frames_done = ended.done;
  active->stored.frames_failed = ended.failed;
  if (!active->read.job.videos.empty() && active->videos().empty()) {
    note(*active, v1::LOG_LEVEL_INFO, std::nullopt, {},
         "no video is made of some of the job's frames: 'fetch' brings their pictures, 'hyades "
         "video' makes one of them");
  }
  if (!ended.cancelled && ended.failed == 0 && !active->videos().empty()) {
    begin_videos(*active);
  } else {
    end_job(*active, ended.cancelled, {});
  }
}

/// The job leaves memory once its end is stored. `why` says why it has failed although its frames
/// have not. With the lock.
void Controller::end_job(ActiveJob& active, bool cancelled, const std::string& why) {
  active.ending = true;
  StoredJob& stored = active.stored;
  stored.state = cancelled                                  ? StoredState::cancelled
                 : stored.frames_failed > 0 || !why.empty() ? StoredState::failed
                                                            : StoredState::done;
  stored.ended_ms = wall_ms();
  stored.reason = farm::wire_text(why);
  for (const auto& [number, frame] : active.frames) {
    if (frame.state == v1::FRAME_STATE_FAILED && stored.reason.empty()) {
      stored.reason = fmt::format("frame {} failed: {}", number, frame.reason);
    }
  }
  note(active, v1::LOG_LEVEL_INFO, std::nullopt, {},
       fmt::format("ended: {} frames done, {} failed{}", stored.frames_done, stored.frames_failed,
                   cancelled ? ", cancelled" : ""));
  background_.add(stored.id, [this, id = stored.id] { return store_end(id); });
}

bool Controller::store_end(uint64_t id) {
  StoredJob job;
  {
    const std::lock_guard lock(mutex_);
    job = active_job(id)->stored;
  }
  // The end first: on a full disk there may be room for it alone.
  const core::Status done = store_->update_job(job);
  std::vector<StoredLine> lines;
  {
    const std::lock_guard lock(mutex_);
    ActiveJob* over = active_job(id);
    if (!done) {
      over->row_trouble = "its end cannot be stored: " + done.error().message;
      over->touch();
      return false;
    }
    lines = over->take_lines();
  }
  if (!lines.empty() && !store_->add_lines(id, lines)) {
    // The job is over for whoever waits for it; its last words come as long as there is hope.
    background_.add(id, [this, id, lines = std::move(lines), tries = 0]() mutable {
      const auto still = store_->state(id);
      const bool deleted = still && !*still;
      return deleted || store_->add_lines(id, lines).ok() || ++tries == kMostTries;
    });
  }
  std::unique_ptr<ActiveJob> over;
  std::vector<Waiter> told;
  {
    const std::lock_guard lock(mutex_);
    over = std::move(jobs_.extract(JobId{id}).mapped());
    leaving_.insert(id);
    told = take_waiters([&](const Waiter& waiter) { return waiter.job == id; });
    for (const auto& [number, watch] : watches_) {
      if (watch.job == id) tell_watcher(watch.poke);
    }
  }
  for (const Waiter& waiter : told) waiter.then(grpc::Status::OK, describe(job));
  over.reset();  // waits for the film store's thread
  // Films of frames that failed stay, should they be taken up again.
  std::error_code ignored;
  if (job.state == StoredState::done) std::filesystem::remove_all(films_folder(id), ignored);
  {
    const std::lock_guard lock(mutex_);
    leaving_.erase(id);
  }
  away_wake_.notify_all();
  return true;
}

}  // namespace hyades::coordinator
