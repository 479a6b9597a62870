#include "coordinator/local/local_run.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "core/base/overloaded.h"
#include "core/base/text.h"

namespace hyades::coordinator {
namespace {

/// "the disk is full" of "cannot write FILE: the disk is full".
std::string reason_of(const std::string& trouble) {
  const size_t colon = trouble.rfind(": ");
  return colon == std::string::npos ? trouble : trouble.substr(colon + 2);
}

SchedulerOptions scheduler_options(const LocalPlan& plan) {
  SchedulerOptions options;
  options.scene_time = Duration{0};  // the threads share them
  options.unit_time = plan.unit_time;
  // Threads neither vanish nor fall behind each other for long.
  options.lease_time = std::chrono::hours(24 * 365);
  options.copy_after = Duration{0};
  return options;
}

}  // namespace

LocalRun::LocalRun(LocalPlan plan, const FilmStoreOptions& log, FrameSource& source,
                   FrameSink& sink, FilmAudience* audience)
    : plan_(std::move(plan)),
      source_(source),
      sink_(sink),
      audience_(audience),
      scheduler_(scheduler_options(plan_)),
      film_store_({plan_.frames, plan_.region, plan_.samples, plan_.threshold.adaptive()}, log,
                  *this) {
  plan_.threads = std::max(plan_.threads, 1);
}

LocalRun::~LocalRun() {
  stop();
  for (std::thread& thread : threads_) thread.join();
  film_store_.join();
}

core::Status LocalRun::start() {
  if (plan_.region.empty() || plan_.samples == 0 || plan_.tile_size < 1) {
    return core::Error{"there is nothing to render"};
  }
  if (batches_of(plan_).end() > core::batch_count(plan_.samples)) {
    return core::Error{"there are not so many batches"};
  }
  if (plan_.threshold.adaptive() && plan_.batches.count > 0) {
    return core::Error{"whether tiles have samples enough cannot be told of some batches alone"};
  }
  auto contents = film_store_.open();
  if (!contents) return contents.error();
  log_problems_ = contents->problems;
  if (contents->cut.tile_size > 0) plan_.tile_size = contents->cut.tile_size;

  JobAdded job;
  {
    const core::MutexLock lock(mutex_);
    job = recover(*contents);
    before_ = progress_;
    for (int i = 0; i < plan_.threads; ++i) task_queues_.push_back(std::make_unique<TaskQueue>());
  }
  if (core::Status kept = film_store_.start(plan_.tile_size); !kept) return kept;
  for (int i = 0; i < plan_.threads; ++i) {
    tell(WorkerJoined{WorkerId{static_cast<uint64_t>(i)}, 1, {}, {}});
  }
  carry_out(tell(job));
  for (int i = 0; i < plan_.threads; ++i) threads_.emplace_back([this, i] { render_loop(i); });
  threads_.emplace_back([this] { load_loop(); });
  threads_.emplace_back([this] { finish_loop(); });
  return {};
}

/// The job as the scheduler shall know it, with what the log holds of it; the progress begins
/// there.
JobAdded LocalRun::recover(const LogContents& contents) {
  JobAdded job;
  job.job = kJob;
  job.plan.frames = plan_.frames;
  job.plan.region = plan_.region;
  job.plan.tile_size = plan_.tile_size;
  job.plan.batches = batches_of(plan_).count;
  job.plan.rounds = plan_.threshold.rounds;
  job.plan.shuffle = plan_.shuffle;
  job.plan.frames_in_flight = plan_.frames_in_flight;
  for (const int32_t frame : plan_.frames) restore(contents, frame, job.restored);
  progress_.noise_aim = plan_.threshold.aim.noise;
  progress_.frames = static_cast<uint32_t>(plan_.frames.size());
  progress_.frames_done = static_cast<uint32_t>(job.restored.finished.size());
  progress_.samples = samples_per_frame() * plan_.frames.size();
  samples_before_ = progress_.samples_done;
  started_ = std::chrono::steady_clock::now();
  rendering_ = plan_.threads;
  return job;
}

/// A finished frame counts as long as its outputs are there; of others the films do.
void LocalRun::restore(const LogContents& contents, int32_t frame, RestoredJob& restored) {
  if (contents.finished.contains(frame)) {
    if (!sink_.outputs_exist(frame)) return film_store_.reopen(frame);
    restored.finished.push_back(frame);
    progress_.samples_done += samples_per_frame();
  } else if (const auto film = contents.films.find(frame); film != contents.films.end()) {
    for (core::Unit unit :
         units_of(frame, film->second->coverage(), plan_.region, plan_.tile_size)) {
      unit.batches.first -= batches_of(plan_).first;
      restored.accepted.push_back({unit, Digest{}, {}});
      frame_samples_[frame] += samples_of(unit);
    }
    progress_.samples_done += frame_samples_[frame];
  }
}

void LocalRun::stop() {
  const core::MutexLock lock(mutex_);
  end_locked({});
}

void LocalRun::end_locked(const std::string& error) {
  if (!error.empty() && outcome_.error.empty()) outcome_.error = error;
  stop_ = true;
  ending_ = true;
  for (const auto& queue : task_queues_) queue->wake.notify_all();
  load_wake_.notify_all();
  finish_wake_.notify_all();
  film_store_.hurry();
}

bool LocalRun::wait_for(Duration duration) {
  const TimePoint end = std::chrono::steady_clock::now() + duration;
  const core::MutexLock lock(mutex_);
  while (!over_ && std::chrono::steady_clock::now() < end) over_wake_.wait_until(mutex_, end);
  return over_;
}

Progress LocalRun::progress() const {
  Progress p;
  {
    const core::MutexLock lock(mutex_);
    p = progress_;
    p.samples = expected_samples(p.samples_done, spared_, p.samples - spared_ - p.samples_done);
    p.frames_finishing = static_cast<uint32_t>(complete_.size());
    p.frames_in_flight.assign(in_flight_.begin(), in_flight_.end());
    const TimePoint now = std::chrono::steady_clock::now();
    p.elapsed = seconds(now - started_);
    if (first_lease_) {
      const double rendered = seconds(now - *first_lease_);
      const uint64_t done = p.samples_done - std::min(samples_before_, p.samples_done);
      if (rendered > 0 && done > 0) {
        p.samples_per_second = static_cast<double>(done) / rendered;
        p.seconds_left = static_cast<double>(p.samples - p.samples_done) / p.samples_per_second;
      }
    }
  }
  if (const std::string trouble = film_store_.trouble(); !trouble.empty()) {
    p.trouble = "waits for the disk: " + reason_of(trouble);
  }
  return p;
}

std::vector<FrameTime> LocalRun::take_finished() {
  const core::MutexLock lock(mutex_);
  return std::exchange(finished_, {});
}

LocalOutcome LocalRun::outcome() const {
  const core::MutexLock lock(mutex_);
  LocalOutcome outcome = outcome_;
  outcome.frames_done = progress_.frames_done;
  return outcome;
}

std::vector<LocalRun::DeferredAction> LocalRun::tell(const Event& event) {
  const core::MutexLock lock(mutex_);
  return tell_locked(event);
}

/// Feeds the scheduler, puts leases and frames to load into their queues, and returns what
/// carry_out() does without the lock.
std::vector<LocalRun::DeferredAction> LocalRun::tell_locked(const Event& event) {
  std::vector<DeferredAction> deferred;
  for (Action& action : scheduler_.handle(event, std::chrono::steady_clock::now())) {
    std::visit(core::Overloaded{
                   [&](Lease& lease) HYADES_REQUIRES(mutex_) { hand_out(lease); },
                   [&](JudgeTile& judge) { judge_later(judge); },
                   [&](TileSpared& spared) HYADES_REQUIRES(mutex_) { spare(spared); },
                   [&](OpenFrame& open) HYADES_REQUIRES(mutex_) {
                     in_flight_.insert(open.frame);
                     to_load_.push_back(open.frame);
                     load_wake_.notify_one();
                   },
                   // Threads do not forget, do not fall behind each other and are all of one
                   // machine.
                   [](SetAside&) {},
                   [](Revoke&) {},
                   [](Acknowledge&) {},
                   [](Conflict&) {},
                   [](Quarantine&) {},
                   [](Confirmed&) {},
                   [](TileVoided&) {},
                   [](FrameReopened&) {},
                   [](FrameRestarted&) {},
                   [&](auto& other) { deferred.emplace_back(std::move(other)); },
               },
               action);
  }
  return deferred;
}

void LocalRun::hand_out(const Lease& lease) {
  if (!first_lease_) first_lease_ = std::chrono::steady_clock::now();
  TaskQueue& queue = *task_queues_[static_cast<size_t>(lease.worker)];
  for (const core::Unit& unit : lease.units) {
    begun_.try_emplace(unit.frame, std::chrono::steady_clock::now());
    queue.tasks.push_back({unit, lease.lease, works_.at(unit.frame)});
  }
  queue.wake.notify_one();
}

void LocalRun::persisted(RecordId record) { carry_out(tell(Persisted{record})); }

void LocalRun::not_persisted(RecordId record, const std::string& reason) {
  carry_out(tell(PersistFailed{record, reason}));
}

void LocalRun::outgrown(int32_t frame, const std::string& reason) {
  const std::vector<DeferredAction> actions = tell(FrameRefused{kJob, frame, reason});
  {
    const core::MutexLock lock(mutex_);
    outgrown_.insert(frame);
  }
  carry_out(actions);
}

void LocalRun::try_again() { carry_out(tell(Tick{})); }

void LocalRun::storage_failed(const std::string& reason) {
  const core::MutexLock lock(mutex_);
  end_locked("films cannot be stored: " + reason);
}

void LocalRun::drained() {
  const core::MutexLock lock(mutex_);
  over_ = true;
  over_wake_.notify_all();
}

}  // namespace hyades::coordinator
