// What goes on beside the calls of workers and clients.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/finisher/finish_process.h"
#include "coordinator/meters/meters.h"
#include "core/base/failpoint.h"
#include "core/base/fp_mode.h"
#include "core/job/film_file.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr Duration kClock = std::chrono::milliseconds(50);
constexpr Duration kPokeEvery = std::chrono::milliseconds(200);
constexpr Duration kFinishAgain = std::chrono::seconds(1);
constexpr Duration kLinesAgain = std::chrono::seconds(1);
/// How far the account of a job may lag behind in the store.
constexpr Duration kStoreCoreEvery = std::chrono::seconds(10);

}  // namespace

/// What the job's colour configuration consists of, where it has one; without the lock.
core::Status Controller::find_color_files(FinishTask& task,
                                          const std::vector<core::AssetRecord>& files) {
  if (!task.color) return {};
  const std::vector<std::string>& named = task.color->files;
  for (const core::AssetRecord& file : files) {
    const bool wanted = file.reference == task.color->config ||
                        std::find(named.begin(), named.end(), file.reference) != named.end();
    if (!wanted) continue;
    auto bytes = assets_->read(file.sha256);
    if (!bytes) return bytes.error().in(file.reference);
    task.color_files.emplace_back(file.reference, std::move(*bytes));
  }
  return {};
}

void Controller::finish_loop() {
  const core::FpMode mode;
  std::unique_lock lock(mutex_);
  for (;;) {
    finish_wake_.wait(lock, [&] { return stop_ || !to_finish_.empty(); });
    if (stop_) return;
    const Completed completed = std::move(to_finish_.front());
    to_finish_.pop_front();
    ActiveJob* active = active_job(completed.job);
    if (active == nullptr) continue;
    const auto id = static_cast<uint64_t>(completed.job);
    FinishTask task;
    task.info = active->film_info(completed.frame);
    const FrameNote& note = active->frames[completed.frame];
    task.info.worker_class = note.worker_class;
    task.outputs = active->read.job.outputs;
    if (active->read.job.keep_films) task.film = core::film_file(active->read.job);
    task.folder = output_folder(id);
    task.color = active->read.job.color;
    std::vector<core::AssetRecord> assets;
    if (task.color) assets = active->read.assets;
    const StoredFrame over{completed.frame, true,     {}, note.worker_class, note.restarts,
                           completed.parts, ++moment_};
    const int64_t begun_us = wall_us();
    lock.unlock();

    const std::string scratch = fmt::format("{}/tmp/{}-{}", options_.folder, id, completed.frame);
    core::Status done = find_color_files(task, assets);
    core::Result<std::vector<FinishedFile>> files = core::Error{};
    if (done) {
      files = run_finisher(options_.finisher, scratch, task, *completed.film, stop_);
      if (!files) done = files.error();
    }
    if (done) {
      std::vector<StoredOutput> outputs;
      for (const FinishedFile& file : *files) {
        const auto digest = farm::digest_from_hex(file.sha256);
        outputs.push_back({file.path, completed.frame, file.size,
                           digest ? farm::to_wire(*digest) : std::string()});
      }
      core::failpoint("outputs-written");
      done = store_->frame_over(id, over, outputs);
      core::failpoint("frame-stored");
    }
    // What is written and cannot be stored is no fault of the frame's, nor is a full disk.
    const bool waits = !done && (files || disk_is_short_for(*completed.film));
    lock.lock();
    if (stop_) return;
    if (waits) {
      if (ActiveJob* still = active_job(completed.job)) {
        still->trouble =
            fmt::format("frame {} waits {} to be finished: {}", completed.frame,
                        files ? "for the job store" : "for room on the disk", done.error().message);
        still->touch();
        to_finish_.push_back(completed);
      }
      finish_wake_.wait_for(lock, kFinishAgain, [&] { return stop_.load(); });
      continue;
    }
    if (!done) {
      finish_wake_.wait_for(lock, kFinishAgain, [&] { return stop_.load(); });
      if (stop_) return;
    }
    if (done) {
      core::Unit all;
      all.frame = completed.frame;
      meters_->finished(std::chrono::microseconds(std::max<int64_t>(wall_us() - begun_us, 0)));
      timelines_.note(id, {v1::TimelineStep::KIND_FINISH, {}, 0, all, begun_us, wall_us()});
    }
    const std::vector<Action> later =
        done ? tell(FinishDone{completed.job, completed.frame})
             : tell(FinishFailed{completed.job, completed.frame, done.error().message});
    lock.unlock();
    carry_out(later);
    lock.lock();
  }
}

void Controller::clock_loop() {
  std::unique_lock lock(mutex_);
  TimePoint last_poke;
  while (!stop_) {
    clock_wake_.wait_for(lock, kClock, [&] { return stop_.load(); });
    if (stop_) return;
    const TimePoint now = std::chrono::steady_clock::now();
    std::vector<Action> later;
    if (const auto wake = scheduler_.next_wake(); wake && *wake <= now) later = tell(Tick{});
    for (Action& action : mind_workers(now)) later.push_back(std::move(action));
    if (now - last_poke >= kPokeEvery) {
      last_poke = now;
      mind_jobs(now);
    }
    lock.unlock();
    mind_waiters(now);
    carry_out(later);
    lock.lock();
  }
}

/// Workers that are gone, and wishes that waited for adoption; with the lock.
std::vector<Action> Controller::mind_workers(TimePoint now) {
  std::vector<Action> later;
  const auto add = [&](std::vector<Action> actions) {
    for (Action& action : actions) later.push_back(std::move(action));
  };
  for (auto it = sessions_.begin(); it != sessions_.end();) {
    WorkerSession& session = it->second;
    if (session.link && now - session.heard > options_.lease_time) {
      session.link->close({grpc::StatusCode::DEADLINE_EXCEEDED, "not heard of for too long"});
      session.link.reset();
      session.lost_at = now;
    }
    if (session.lost_at && session.joined &&
        (session.leaving || now - *session.lost_at > options_.reconnect_time)) {
      session.joined = false;
      if (session.state != v1::WORKER_STATE_QUARANTINED) session.state = v1::WORKER_STATE_GONE;
      note_losses(session, scheduler_.units_of(session.id),
                  session.leaving ? "has left" : "is lost");
      if (!session.leaving) meters_->worker_lost();
      add(tell(WorkerLost{session.id}));
    }
    if (session.held_wish > 0 && session.joined && now >= adopting_until_) {
      add(tell(WorkRequested{session.id, std::exchange(session.held_wish, 0)}));
    }
    const WorkerId id = it->first;
    ++it;
    if (session.lost_at && now - *session.lost_at > options_.forget_time) add(forget(id));
  }
  return later;
}

/// Speeds, lines to store, and those who watch; with the lock.
void Controller::mind_jobs(TimePoint now) {
  for (auto& [id, active] : jobs_) {
    active->speed.note(active->samples_done, now);
    if (active->stored.core_ns != active->core_ns_stored && !active->ending && !disk_full_ &&
        now - active->core_stored >= kStoreCoreEvery) {
      active->core_stored = now;
      store_row(*active);
    }
    if (active->lines.empty() || active->storing_lines || active->ending || disk_full_) continue;
    if (now < active->lines_again) continue;
    active->storing_lines = true;
    background_.add(active->stored.id, [this, id = active->id] { return store_lines(id); });
  }
  for (auto& [id, session] : sessions_) {
    if (session.joined) session.speed.note(session.samples_done, now);
  }
  for (auto& [number, watch] : watches_) {
    const ActiveJob* active = active_job(watch.job);
    if (active == nullptr || active->version == watch.version) continue;
    watch.version = active->version;
    tell_watcher(watch.poke);
  }
}

/// Where they cannot be stored they wait in memory, and hold up none of the job's tasks.
bool Controller::store_lines(JobId id) {
  std::vector<StoredLine> lines;
  {
    const std::lock_guard lock(mutex_);
    ActiveJob* active = active_job(id);
    if (active == nullptr) return true;
    if (!active->lines.empty()) lines = active->take_lines();
  }
  const core::Status stored = store_->add_lines(static_cast<uint64_t>(id), lines);
  const std::lock_guard lock(mutex_);
  ActiveJob* still = active_job(id);
  if (still == nullptr) return true;
  still->storing_lines = false;
  if (stored) return true;
  still->put_back(std::move(lines));
  still->lines_again = std::chrono::steady_clock::now() + kLinesAgain;
  return true;
}

/// By another thread, as it is told with the lock.
void Controller::tell_watcher(const std::function<void()>& poke) {
  (void)pokes_.submit(poke);  // takes any number
}

}  // namespace hyades::coordinator
