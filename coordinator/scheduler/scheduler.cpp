#include "coordinator/scheduler/scheduler.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "coordinator/scheduler/granting.h"
#include "coordinator/scheduler/job_lifecycle.h"
#include "coordinator/scheduler/results.h"
#include "core/base/overloaded.h"

namespace hyades::coordinator {

/// What the scheduler is made of: tables at first, then what changes them. Each part uses only
/// those above it.
struct Scheduler::Parts {
  explicit Parts(const SchedulerOptions& given) : options(given) {}

  const SchedulerOptions options;
  Step step;
  PendingRecords records{options, step};
  ScheduledJobs jobs{step, records};
  ScheduledWorkers workers{step};
  FilmBudget films{options.film_memory, step};
  Leases leases{options, step, jobs, workers, films};
  Affinity affinity{options, step, jobs};
  HedgedCopies copies{options, step, jobs, workers, leases, affinity};
  FrameLifecycle frames{options, step, jobs, workers, films, leases, records, affinity};
  WorkerLifecycle worker_lifecycle{options, step,     jobs,   workers, films,
                                   leases,  affinity, copies, frames};
  Conflicts conflicts{step, jobs, leases, records, frames, worker_lifecycle};
  JobLifecycle job_lifecycle{jobs, workers, films, leases, frames, conflicts};
  Results results{step,     jobs,   workers,          films,    leases, records,
                  affinity, frames, worker_lifecycle, conflicts};
  Granting granting{options, step, jobs, workers, films, leases, records, affinity, copies, frames};

  /// The sum of what the ledgers of the job's frames tell.
  uint32_t count(JobId id, size_t (FrameLedger::*units)() const) const {
    const ScheduledJob* job = jobs.find(id);
    size_t all = 0;
    for (const uint32_t i : job == nullptr ? std::vector<uint32_t>() : job->in_flight) {
      const FrameSlot& slot = job->slots[i];
      if (slot.ledger) all += ((*slot.ledger).*units)();
    }
    return static_cast<uint32_t>(all);
  }
};

Scheduler::Scheduler(const SchedulerOptions& options) : parts_(std::make_unique<Parts>(options)) {}

Scheduler::~Scheduler() = default;

std::vector<Action> Scheduler::handle(const Event& event, TimePoint now) {
  Parts& p = *parts_;
  p.step.now = std::max(p.step.now, now);
  std::visit(
      core::Overloaded{
          [&](const JobAdded& e) { p.job_lifecycle.on(e); },
          [&](const JobPaused& e) {
            p.job_lifecycle.on(e);
            p.granting.look_for_room();
          },
          [&](const JobResumed& e) { p.job_lifecycle.on(e); },
          [&](const JobCancelled& e) { p.job_lifecycle.on(e); },
          [&](const JobReprioritised& e) { p.job_lifecycle.on(e); },
          [&](const FramesRetried& e) { p.job_lifecycle.on(e); },
          [&](const FramesSuspected& e) { p.job_lifecycle.on(e); },
          [&](const FrameOpened& e) { p.frames.on(e); },
          [&](const FrameRefused& e) { p.frames.on(e); },
          [&](const FilmSetAside& e) { p.frames.on(e); },
          [&](const FinishDone& e) { p.frames.on(e); },
          [&](const FinishFailed& e) { p.frames.on(e); },
          [&](const TileJudged& e) { p.frames.on(e); },
          [&](const WorkerJoined& e) { p.worker_lifecycle.on(e); },
          [&](const WorkerAlive& e) { p.worker_lifecycle.on(e); },
          [&](const WorkerBarred& e) { p.worker_lifecycle.on(e); },
          [&](const WorkerLost& e) { p.worker_lifecycle.on(e); },
          [&](const WorkerForgotten& e) { p.worker_lifecycle.on(e); },
          [&](const WorkRequested& e) { p.granting.on(e); },
          [&](const LeasingHeld& e) { p.granting.on(e); },
          [&](const FrameWatched& e) { p.granting.on(e); },
          [&](const ResultArrived& e) { p.results.on(e); },
          [&](const UnitFailed& e) { p.results.on(e); },
          [&](const UnitReturned& e) { p.results.on(e); },
          [&](const Persisted& e) { p.results.on(e); },
          [&](const PersistFailed& e) { p.results.on(e); },
          [&](const Tick& e) {
            p.leases.expire();
            p.records.retry([&](const Record& record) { return p.conflicts.still_wanted(record); });
            p.frames.restart_stranded(p.granting.may_lease());
            p.granting.on(e);
          },
      },
      event);
  p.conflicts.end_marks();
  p.granting.dispatch();
  return std::exchange(p.step.actions, {});
}

std::optional<TimePoint> Scheduler::next_wake() const {
  std::optional<TimePoint> wake;
  const auto at = [&](std::optional<TimePoint> t) {
    if (t) wake = wake ? std::min(*wake, *t) : *t;
  };
  at(parts_->leases.next_deadline());
  at(parts_->records.next_wake());
  at(parts_->frames.next_wake());
  at(parts_->conflicts.next_wake());
  at(parts_->granting.next_wake());
  return wake;
}

bool Scheduler::knows(JobId id) const { return parts_->jobs.find(id) != nullptr; }

uint32_t Scheduler::leased_units(JobId id) const {
  const ScheduledJob* job = parts_->jobs.find(id);
  return job == nullptr ? 0 : static_cast<uint32_t>(job->running);
}

uint32_t Scheduler::leased_units(WorkerId id) const {
  const Worker* worker = parts_->workers.find(id);
  return worker == nullptr ? 0 : worker->units;
}

std::vector<UnitInHand> Scheduler::units_of(WorkerId worker, const LeaseId& lease) const {
  return parts_->leases.units_of(worker, lease);
}

bool Scheduler::has_lease(WorkerId worker, const LeaseId& lease) const {
  return parts_->leases.is_of(lease, worker);
}

bool Scheduler::holds(WorkerId worker, const LeaseId& lease, JobId job,
                      const core::Unit& unit) const {
  return parts_->leases.holds(worker, lease, job, unit);
}

TimePoint Scheduler::since(const UnitInHand& held) const { return parts_->leases.since(held); }

std::vector<UnitInHand> Scheduler::units_of(WorkerId worker) const {
  return parts_->leases.units_of(worker);
}

std::vector<std::pair<WorkerId, UnitInHand>> Scheduler::units_of(JobId job) const {
  return parts_->leases.units_of(job);
}

uint32_t Scheduler::disputed_units(JobId id) const {
  return parts_->count(id, &FrameLedger::disputes);
}

uint32_t Scheduler::units_to_confirm(JobId id) const {
  return parts_->count(id, &FrameLedger::unconfirmed_checks);
}

uint64_t Scheduler::films() const { return parts_->films.bytes(); }

bool Scheduler::waits_for_film(JobId id) const {
  const ScheduledJob* job = parts_->jobs.find(id);
  return job != nullptr && parts_->granting.waits_for_film(*job);
}

std::string Scheduler::audit() const {
  std::map<std::pair<JobId, uint32_t>, size_t> out;
  if (std::string wrong = parts_->leases.audit(out); !wrong.empty()) return wrong;
  const auto is_open = [this](JobId id) { return knows(id); };
  if (std::string wrong = parts_->records.audit(is_open); !wrong.empty()) return wrong;
  std::map<const FairShare*, uint64_t> running;
  uint64_t films = 0;
  for (const auto& [id, job] : parts_->jobs.all()) {
    running.try_emplace(job->share, 0);
    for (uint32_t i = 0; i < job->slots.size(); ++i) {
      const FrameSlot& slot = job->slots[i];
      films += slot.film ? job->plan.film_bytes : 0;
      const auto units = out.find({id, i});
      const size_t leased = units == out.end() ? 0 : units->second;
      running[job->share] += leased;
      const bool listed = std::count(job->in_flight.begin(), job->in_flight.end(), i) == 1;
      if (listed != slot.in_flight())
        return fmt::format("frame {} is in the wrong list", slot.frame);
      if (!slot.ledger) continue;
      if (slot.ledger->holders() != leased) {
        return fmt::format("frame {}: {} units assigned, {} leased", slot.frame,
                           slot.ledger->holders(), leased);
      }
      if (std::string wrong = slot.ledger->audit(); !wrong.empty()) {
        return fmt::format("frame {}: {}", slot.frame, wrong);
      }
    }
  }
  for (const auto& [of, share] : parts_->jobs.shares()) {
    if (!running.contains(&share)) return "an owner without jobs is not forgotten";
    if (share.running != running[&share]) return "an owner's running units are miscounted";
  }
  if (films != parts_->films.bytes()) {
    return fmt::format("films take {} bytes, {} counted", films, parts_->films.bytes());
  }
  return {};
}

}  // namespace hyades::coordinator
