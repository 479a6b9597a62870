// Opening the folder, taking up jobs, and the brain's own threads.
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "coordinator/brain/brain.h"
#include "coordinator/brain/keeper_owner.h"
#include "coordinator/finisher/finish_process.h"
#include "core/base/failpoint.h"
#include "core/base/fp_mode.h"
#include "core/base/machine.h"
#include "core/job/film_file.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kWaitingBytes = uint64_t{256} << 20U;
constexpr Duration kClock = std::chrono::milliseconds(50);
constexpr Duration kPokeEvery = std::chrono::milliseconds(200);
constexpr Duration kForgetAfter = std::chrono::hours(1);
constexpr Duration kFinishAgain = std::chrono::seconds(1);

/// Films of a progressive job that may be in memory together, and frames that may be.
constexpr uint64_t kProgressiveBytes = uint64_t{2} << 30U;
constexpr uint64_t kMostAtOnce = 256;

/// How many frames of a job may be in work together: no more than half of `film_memory` holds, or
/// one.
uint32_t frames_at_once(const JobDesk& desk, uint64_t film_memory) {
  const uint64_t film = std::max<uint64_t>(desk.film_bytes, 1);
  const uint64_t wanted = desk.stored.frame_order == v1::FRAME_ORDER_PROGRESSIVE
                              ? std::clamp<uint64_t>(kProgressiveBytes / film, 3, kMostAtOnce)
                              : JobPlan{}.frames_in_flight;
  return static_cast<uint32_t>(std::clamp<uint64_t>(film_memory / 2 / film, 1, wanted));
}

SchedulerOptions scheduler_options(const BrainOptions& options, uint64_t incarnation) {
  SchedulerOptions scheduler;
  scheduler.incarnation = incarnation;
  scheduler.unit_time = options.unit_time;
  scheduler.lease_time = options.lease_time;
  scheduler.copy_after = options.copy_after;
  scheduler.class_patience = options.class_patience;
  return scheduler;
}

}  // namespace

uint64_t default_film_memory() {
  const uint64_t memory = core::machine_memory();
  return memory > 0 ? memory / 2 : UINT64_MAX;
}

core::Result<std::unique_ptr<Brain>> Brain::open(const BrainOptions& options) {
  std::error_code failed;
  for (const char* part : {"", "/films", "/outputs", "/tmp"}) {
    std::filesystem::create_directories(options.folder + part, failed);
    if (failed) return core::Error{options.folder + part + ": " + failed.message()};
  }
  for (const auto& left : std::filesystem::directory_iterator(options.folder + "/tmp", failed)) {
    std::filesystem::remove_all(left.path(), failed);
  }
  auto store = open_sqlite_job_store(options.folder + "/state.db");
  if (!store) return store.error();
  auto assets = farm::ContentStore::open({options.folder + "/assets", 0});
  if (!assets) return assets.error();
  const auto incarnation = (*store)->next_incarnation();
  if (!incarnation) return incarnation.error();
  std::unique_ptr<Brain> brain(
      new Brain(options, std::move(*store), std::move(*assets), *incarnation));
  const auto quarantines = brain->store_->quarantines();
  if (!quarantines) return quarantines.error();
  for (const StoredQuarantine& kept : *quarantines) {
    brain->quarantines_[kept.worker] = kept.reason;
  }
  if (auto taken = brain->take_up_jobs(); !taken) return taken.error();
  // From here on workers can come: to take up many jobs may take longer than they are given.
  if (*incarnation > 1) {
    brain->adopting_until_ = std::chrono::steady_clock::now() + options.adoption_time;
  }
  Brain& b = *brain;
  b.threads_.emplace_back([&b] { b.clock_loop(); });
  b.threads_.emplace_back([&b] { b.finish_loop(); });
  b.threads_.emplace_back([&b] { b.sweep_loop(); });
  b.threads_.emplace_back([&b] { b.disk_loop(); });
  b.threads_.emplace_back([&b] { b.chores_loop(); });
  return brain;
}

Brain::Brain(BrainOptions options, std::unique_ptr<JobStore> store,
             std::unique_ptr<farm::ContentStore> assets, uint64_t incarnation)
    : options_(std::move(options)),
      store_(std::move(store)),
      assets_(std::move(assets)),
      incarnation_(incarnation),
      started_ms_(wall_ms()),
      scheduler_(scheduler_options(options_, incarnation)),
      disk_(options_.disk) {}

void Brain::stop() {
  stop_ = true;
  const std::lock_guard lock(mutex_);
  clock_wake_.notify_all();
  finish_wake_.notify_all();
  sweep_wake_.notify_all();
  disk_wake_.notify_all();
  for (auto& [id, seat] : seats_) {
    if (seat.link) seat.link->close({grpc::StatusCode::UNAVAILABLE, "the coordinator stops"});
  }
}

Brain::~Brain() {
  stop();
  // The chores go last: others leave them some.
  for (size_t i = 0; i + 1 < threads_.size(); ++i) threads_[i].join();
  {
    const std::lock_guard lock(mutex_);
    chores_end_ = true;
    chores_wake_.notify_all();
  }
  if (!threads_.empty()) threads_.back().join();
  std::map<JobId, std::unique_ptr<JobDesk>> desks;
  {
    const std::lock_guard lock(mutex_);
    desks = std::exchange(desks_, {});
  }
}

std::string Brain::output_folder(uint64_t job) const {
  return fmt::format("{}/outputs/{}", options_.folder, job);
}

std::string Brain::films_folder(uint64_t job) const {
  return fmt::format("{}/films/{}", options_.folder, job);
}

core::Status Brain::take_up_jobs() {
  const auto ids = store_->open_jobs();
  if (!ids) return ids.error();
  for (const uint64_t id : *ids) {
    core::Status taken = take_up(id);
    if (taken) continue;
    // The job fails alone, with the reason kept; `retry` takes it up again.
    auto stored = store_->job(id);
    if (!stored) return stored.error();
    (*stored)->state = StoredState::failed;
    (*stored)->ended_ms = wall_ms();
    (*stored)->reason = "could not be taken up again: " + taken.error().message;
    if (auto noted = store_->update_job(**stored); !noted) return noted;
  }
  return {};
}

core::Status Brain::take_up(uint64_t id) {
  auto stored = store_->job(id);
  if (!stored) return stored.error();
  if (!*stored) return core::Error{"it is not there"};
  v1::JobSpec spec;
  if (!spec.ParseFromString((*stored)->spec)) return core::Error{"its record is damaged"};
  for (const v1::JobFile& file : spec.files()) {
    if (is_here(file)) continue;
    return core::Error{file.path() +
                       " is gone or damaged on the coordinator's disk: submit the job (or the "
                       "file with another) again, then 'retry' takes this one up"};
  }
  auto desk = make_desk(**stored, spec, *assets_, options_.film_memory);
  if (!desk) return desk.error();
  (*desk)->id = JobId{id};
  RestoredJob restored;
  const auto frames = store_->frames(id);
  if (!frames) return frames.error();
  const auto damaged = frames_without_outputs(id);
  if (!damaged) return damaged.error();
  for (const StoredFrame& frame : *frames) {
    FrameNote& note = (*desk)->frames[frame.frame];
    if (damaged->contains(frame.frame)) {
      if (auto gone = store_->forget_frame(id, frame.frame); !gone) return gone;
      note.restarts = frame.restarts + 1;
      this->note(**desk, v1::LOG_LEVEL_WARNING, frame.frame, {},
                 "its outputs are gone or damaged: it is rendered again");
      continue;
    }
    note.worker_class = frame.worker_class;
    note.restarts = frame.restarts;
    if (frame.done) {
      restored.finished.push_back(frame.frame);
      note.state = v1::FRAME_STATE_DONE;
      note.samples_done = (*desk)->samples_per_frame;
      (*desk)->samples_done += note.samples_done;
    } else {
      restored.failed.push_back({frame.frame, frame.reason});
      note.state = v1::FRAME_STATE_FAILED;
      note.reason = frame.reason;
    }
  }
  (*desk)->stored.frames_done = static_cast<uint32_t>(restored.finished.size());
  (*desk)->stored.frames_failed = static_cast<uint32_t>(restored.failed.size());
  return start(std::move(*desk), std::move(restored));
}

/// Finished frames of which a file is missing or has another size than when it was written.
core::Result<std::set<int32_t>> Brain::frames_without_outputs(uint64_t id) const {
  const auto outputs = store_->outputs(id, 0, UINT32_MAX);
  if (!outputs) return outputs.error();
  std::set<int32_t> damaged;
  for (const StoredOutput& output : *outputs) {
    std::error_code failed;
    const auto size = std::filesystem::file_size(output_folder(id) + "/" + output.path, failed);
    if (failed || size != output.size) damaged.insert(output.frame);
  }
  return damaged;
}

/// What of the films in a job's log counts.
void Brain::restore_films(JobDesk& desk, const LogContents& contents, RestoredJob& restored) {
  for (const std::string& problem : contents.problems) {
    note(desk, v1::LOG_LEVEL_WARNING, std::nullopt, {}, "films: " + problem);
  }
  for (const auto& [number, units] : contents.units) {
    FrameNote& frame = desk.frames[number];
    if (frame.state != v1::FRAME_STATE_WAITING) {
      desk.keeper->forget(number, frame.state == v1::FRAME_STATE_DONE);
      continue;
    }
    frame.state = v1::FRAME_STATE_RENDERING;
    frame.worker_class = units.front().worker_class;
    for (const AcceptedUnit& unit : units) {
      frame.samples_done +=
          core::samples_in(unit.unit.tile, unit.unit.batches, desk.read.job.sampling.samples);
      restored.accepted.push_back(unit);
    }
    desk.samples_done += frame.samples_done;
    // Will be finished at once, by another thread than the keeper's, which runs by then.
    if (frame.samples_done == desk.samples_per_frame) {
      desk.complete[number] = desk.keeper->film(number);
    }
  }
  for (const auto& [frame, finished] : contents.finished) {
    if (desk.frames[frame].state != v1::FRAME_STATE_DONE) desk.keeper->reopen(frame);
  }
}

/// A keeper of the job's films, not opened yet.
std::unique_ptr<FilmKeeper> Brain::make_keeper(JobDesk& desk, bool resume) {
  LocalPlan plan;
  plan.frames = desk.numbers;
  plan.region = desk.region;
  plan.samples = desk.read.job.sampling.samples;
  plan.max_waiting_bytes = kWaitingBytes;
  LocalLog place;
  place.folder = films_folder(desk.stored.id);
  place.frame_key = [key = desk.key](int32_t) { return key; };
  place.resume = resume;
  place.compact_bytes = options_.compact_bytes;
  if (!desk.owner) desk.owner = std::make_unique<KeeperOwner>(*this, desk.id);
  return std::make_unique<FilmKeeper>(plan, place, *desk.owner);
}

/// A job gets its log and threads with its first film, so that those that wait cost little; with
/// the lock, for some milliseconds once.
core::Status Brain::ensure_keeper(JobDesk& desk) {
  if (desk.keeper) return {};
  auto keeper = make_keeper(desk, false);
  if (auto opened = keeper->open(); !opened) return opened.error();
  const int32_t tile_size = tile_size_of(desk.region, desk.read.job.sampling.samples);
  if (auto started = keeper->start(tile_size); !started) return started;
  desk.keeper = std::move(keeper);
  return {};
}

/// Reads the films that are there, and hands the job to the scheduler.
core::Status Brain::start(std::unique_ptr<JobDesk> owned, RestoredJob restored) {
  JobDesk& desk = *owned;
  int32_t tile_size = tile_size_of(desk.region, desk.read.job.sampling.samples);
  if (std::filesystem::exists(films_folder(desk.stored.id))) {
    desk.keeper = make_keeper(desk, true);
    auto contents = desk.keeper->open();
    if (!contents) return contents.error();
    if (contents->cut.tile_size > 0) tile_size = contents->cut.tile_size;
    restore_films(desk, *contents, restored);
    if (auto started = desk.keeper->start(tile_size); !started) return started;
  }
  JobAdded added;
  added.job = desk.id;
  added.plan.frames = desk.numbers;
  added.plan.region = desk.region;
  added.plan.tile_size = tile_size;
  added.plan.batches = core::batch_count(desk.read.job.sampling.samples);
  added.plan.priority = desk.stored.priority;
  added.plan.owner = desk.stored.owner;
  added.plan.max_workers = desk.stored.max_workers;
  added.plan.max_attempts = desk.stored.max_attempts;
  added.plan.needs = {desk.stored.tags, desk.stored.memory};
  if (desk.stored.frame_order == v1::FRAME_ORDER_PROGRESSIVE) {
    added.plan.order = FrameOrder::progressive;
  }
  added.plan.frames_in_flight = frames_at_once(desk, options_.film_memory);
  added.restored = std::move(restored);
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    const JobId id = desk.id;
    const bool paused = desk.stored.state == StoredState::paused;
    desks_.emplace(id, std::move(owned));
    later = tell(added);
    if (paused) {
      for (Action& action : tell(JobPaused{id})) later.push_back(std::move(action));
    }
  }
  carry_out(later);
  return {};
}

/// Tries again until it is stored, or the coordinator ends; for the chores' thread, without the
/// lock.
void Brain::store_patiently(const std::function<core::Status()>& what) {
  while (!what() && !stop_) std::this_thread::sleep_for(std::chrono::seconds(1));
}

void Brain::chore(std::function<void()> what) {
  chores_.push_back(std::move(what));
  chores_wake_.notify_one();
}

void Brain::chores_loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    chores_wake_.wait(lock, [&] { return chores_end_ || !chores_.empty(); });
    if (chores_.empty()) return;
    const std::function<void()> what = std::move(chores_.front());
    chores_.pop_front();
    lock.unlock();
    what();
    lock.lock();
  }
}

void Brain::finish_loop() {
  const core::FpMode mode;
  std::unique_lock lock(mutex_);
  for (;;) {
    finish_wake_.wait(lock, [&] { return stop_ || !to_finish_.empty(); });
    if (stop_) return;
    const Completed completed = std::move(to_finish_.front());
    to_finish_.pop_front();
    JobDesk* desk = desk_of(completed.job);
    if (desk == nullptr) continue;
    const auto id = static_cast<uint64_t>(completed.job);
    FinishTask task;
    task.info = desk->film_info(completed.frame);
    const FrameNote& note = desk->frames[completed.frame];
    task.info.worker_class = note.worker_class;
    task.outputs = desk->read.job.outputs;
    if (desk->read.job.keep_films) task.film = core::film_file(desk->read.job);
    task.folder = output_folder(id);
    StoredFrame over{completed.frame, true, {}, note.worker_class, note.restarts};
    lock.unlock();

    const std::string scratch = fmt::format("{}/tmp/{}-{}", options_.folder, id, completed.frame);
    auto files = run_finisher(options_.finisher, scratch, task, *completed.film, stop_);
    core::Status done = files ? core::Status() : core::Status(files.error());
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
    const bool short_of_disk = !done && disk_is_short_for(*completed.film);
    lock.lock();
    if (stop_) return;
    if (short_of_disk) {
      // No fault of the frame's: it waits until there is room.
      if (JobDesk* still = desk_of(completed.job)) {
        still->trouble = fmt::format("frame {} waits for room on the disk to be finished: {}",
                                     completed.frame, done.error().message);
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
    const std::vector<Action> later =
        done ? tell(FinishDone{completed.job, completed.frame})
             : tell(FinishFailed{completed.job, completed.frame, done.error().message});
    lock.unlock();
    carry_out(later);
    lock.lock();
  }
}

void Brain::clock_loop() {
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
    if (later.empty()) continue;
    lock.unlock();
    carry_out(later);
    lock.lock();
  }
}

/// Workers that are gone, and wishes that waited for adoption; with the lock.
std::vector<Action> Brain::mind_workers(TimePoint now) {
  std::vector<Action> later;
  const auto add = [&](std::vector<Action> actions) {
    for (Action& action : actions) later.push_back(std::move(action));
  };
  for (auto it = seats_.begin(); it != seats_.end();) {
    Seat& seat = it->second;
    if (seat.link && now - seat.heard > options_.lease_time) {
      seat.link->close({grpc::StatusCode::DEADLINE_EXCEEDED, "not heard of for too long"});
      seat.link.reset();
      seat.lost_at = now;
    }
    if (seat.lost_at && seat.joined &&
        (seat.leaving || now - *seat.lost_at > options_.reconnect_time)) {
      seat.joined = false;
      if (seat.state != v1::WORKER_STATE_QUARANTINED) seat.state = v1::WORKER_STATE_GONE;
      add(tell(WorkerLost{seat.id}));
    }
    if (seat.held_wish > 0 && seat.joined && now >= adopting_until_) {
      add(tell(WorkRequested{seat.id, std::exchange(seat.held_wish, 0)}));
    }
    if (seat.lost_at && now - *seat.lost_at > kForgetAfter) {
      worker_ids_.erase(seat.hello.worker_id());
      it = seats_.erase(it);
    } else {
      ++it;
    }
  }
  return later;
}

/// Speeds, lines to store, and those who watch; with the lock.
void Brain::mind_jobs(TimePoint now) {
  for (auto& [id, desk] : desks_) {
    desk->speed.note(desk->samples_done, now);
    if (desk->lines.empty() || desk->storing_lines || desk->ending) continue;
    desk->storing_lines = true;
    chore([this, id = desk->id, lines = desk->take_lines()] {
      (void)store_->add_lines(static_cast<uint64_t>(id), lines);
      const std::lock_guard lock(mutex_);
      if (JobDesk* still = desk_of(id)) still->storing_lines = false;
    });
  }
  for (auto& [number, watch] : watches_) {
    const JobDesk* desk = desk_of(watch.job);
    if (desk == nullptr || desk->version == watch.version) continue;
    watch.version = desk->version;
    chore(watch.poke);
  }
}

}  // namespace hyades::coordinator
