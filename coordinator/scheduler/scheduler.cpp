#include "coordinator/scheduler/scheduler.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace hyades::coordinator {
namespace {

/// How long a worker waits that came too late for a frame.
constexpr Duration kLookAgain = std::chrono::seconds(1);

}  // namespace

Scheduler::Scheduler(SchedulerOptions options) : options_(options) {
  // Class 0 stands for 'none yet'.
  class_names_.emplace_back();
  class_workers_.push_back(0);
  class_gone_.emplace_back();
}

std::vector<Action> Scheduler::handle(const Event& event, TimePoint now) {
  now_ = std::max(now_, now);
  std::visit([this](const auto& e) { on(e); }, event);
  end_marks();
  dispatch();
  return std::exchange(actions_, {});
}

void Scheduler::on(const JobAdded& e) {
  if (jobs_.contains(e.job)) return;
  auto owned = std::make_unique<JobState>();
  JobState& job = *owned;
  job.id = e.job;
  job.serial = next_job_serial_++;
  job.share = share_of(e.plan.priority, e.plan.owner);
  job.plan = e.plan;
  job.tags = intern_tags(e.plan.needs.tags);
  job.grid = TileGrid(e.plan.region, e.plan.tile_size, e.plan.shuffle);
  job.tile_cost.assign(job.grid.size(), 0.0F);
  for (const int32_t frame : e.plan.frames) {
    const auto index = static_cast<uint32_t>(job.slots.size());
    if (job.by_number.emplace(frame, index).second) job.slots.emplace_back().frame = frame;
  }
  jobs_.emplace(e.job, std::move(owned));
  restore(job, e.restored);
  job.waiting = static_cast<uint64_t>(
      std::count_if(job.slots.begin(), job.slots.end(),
                    [](const FrameSlot& slot) { return slot.phase == FramePhase::waiting; }));
  if (e.restored.disputed) {
    // Nobody knows any more who was odd, and what else it did.
    distrust_restored_ = true;
    job.mark = DisputeMark::open;
    marked_.insert(job.id);
  }
  if (distrust_restored_) doubt_films_of(WorkerId{});
  for (uint32_t i = 0; i < job.slots.size(); ++i) {
    FrameSlot& slot = job.slots[i];
    if (slot.phase == FramePhase::waiting && slot.books && slot.books->complete()) {
      --job.waiting;
      job.in_flight.push_back(i);
      finish(job, slot);
    }
  }
  open_frames(job);
  end_job_if_over(job);
}

void Scheduler::restore(JobState& job, const RestoredJob& restored) {
  for (const int32_t frame : restored.finished) {
    if (FrameSlot* slot = job.slot(frame); slot && slot->phase == FramePhase::waiting) {
      slot->phase = FramePhase::done;
      ++job.frames_done;
    }
  }
  for (const FailedFrame& failed : restored.failed) {
    FrameSlot* slot = job.slot(failed.frame);
    if (slot && slot->phase == FramePhase::waiting) {
      slot->phase = FramePhase::failed;
      slot->reason = failed.reason;
      ++job.frames_failed;
    }
  }
  for (const AcceptedUnit& accepted : restored.accepted) {
    FrameSlot* slot = job.slot(accepted.unit.frame);
    const auto extent = extent_of(job, accepted.unit);
    if (slot == nullptr || slot->phase != FramePhase::waiting || !extent) continue;
    if (!slot->books) {
      slot->books = std::make_unique<FrameState>(job.grid.order(), job.plan.batches);
      slot->worker_class = intern_class(accepted.worker_class);
    }
    if (slot->books->any_held(*extent)) continue;
    slot->books->hold(*extent, {extent->batches, accepted.digest, WorkerId{}, RecordId{}});
  }
}

void Scheduler::on(const JobPaused& e) {
  if (JobState* job = find_job(e.job)) {
    job->paused = true;
    update_ready(*job);
  }
}

void Scheduler::on(const JobResumed& e) {
  if (JobState* job = find_job(e.job)) {
    job->paused = false;
    update_ready(*job);
    open_frames(*job);
  }
}

void Scheduler::on(const JobCancelled& e) {
  JobState* job = find_job(e.job);
  if (job == nullptr) return;
  for (const uint32_t i : job->in_flight) take_back_frame(*job, job->slots[i]);
  job->in_flight.clear();
  update_ready(*job);
  say(JobEnded{e.job, job->frames_done, job->frames_failed, true});
  marked_.erase(e.job);
  jobs_.erase(e.job);
}

void Scheduler::on(const JobReprioritised& e) {
  JobState* job = find_job(e.job);
  if (job == nullptr || job->plan.priority == e.priority) return;
  const auto running = static_cast<int64_t>(job->running);
  list_ready(*job, false);
  set_running(*job, -running);
  job->plan.priority = e.priority;
  work_appeared_ = true;
  job->share = share_of(e.priority, job->plan.owner);
  set_running(*job, running);
  update_ready(*job);
}

void Scheduler::on(const FramesRetried& e) {
  JobState* job = find_job(e.job);
  if (job == nullptr) return;
  for (uint32_t i = 0; i < job->slots.size(); ++i) {
    FrameSlot& slot = job->slots[i];
    if (slot.phase != FramePhase::failed) continue;
    --job->frames_failed;
    job->in_flight.push_back(i);
    restart_frame(*job, slot);
  }
}

void Scheduler::on(const FrameOpened& e) {
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.frame) : nullptr;
  if (slot == nullptr || slot->phase != FramePhase::opening) return;
  slot->phase = FramePhase::rendering;
  void_doubted(*job, *slot);  // what it has from before a restart
  update_ready(*job);
  complete_if_so(*job, *slot);  // a frame without pixels
}

void Scheduler::on(const FrameRefused& e) {
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.frame) : nullptr;
  if (slot == nullptr || slot->phase != FramePhase::opening) return;
  fail_frame(*job, *slot, e.reason);
}

void Scheduler::on(const FinishDone& e) {
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.frame) : nullptr;
  if (slot == nullptr || slot->phase != FramePhase::finishing) return;
  if (!slot->books->settled()) return reopen_frame(*job, *slot);
  slot->phase = FramePhase::closing;
  persist(FrameFinishedRecord{job->id, slot->frame}, {});
}

void Scheduler::on(const FinishFailed& e) {
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.frame) : nullptr;
  if (slot == nullptr || slot->phase != FramePhase::finishing) return;
  if (!slot->books->settled()) return reopen_frame(*job, *slot);
  if (++slot->finish_attempts < job->plan.max_attempts) {
    say(FinishFrame{job->id, slot->frame});
  } else {
    fail_frame(*job, *slot, e.reason);
  }
}

/// Opens frames while there is less than half a frame left to lease, or too little for all threads,
/// or those that are open have workers enough: the next scene is there before the last unit of this
/// one is gone, and not much earlier.
void Scheduler::open_frames(JobState& job) {
  if (job.paused) return;
  const uint64_t frame_total = uint64_t{job.grid.size()} * job.plan.batches;
  const uint64_t enough = std::max(frame_total / 2, 2 * threads_);
  while (job.in_flight.size() < std::max(job.plan.frames_in_flight, 1U)) {
    uint64_t free = 0;
    bool room = false;
    for (const uint32_t i : job.in_flight) {
      const FrameSlot& slot = job.slots[i];
      if (slot.phase == FramePhase::opening || slot.phase == FramePhase::rendering) {
        free += slot.books->free();
        room = room || has_room({&job, i});
      }
    }
    if (room && free > enough && job.plan.order == FrameOrder::sequential) return;
    while (job.next_slot < job.slots.size() &&
           job.slots[job.next_slot].phase != FramePhase::waiting) {
      ++job.next_slot;
    }
    if (job.next_slot == job.slots.size()) return;
    const auto index = static_cast<uint32_t>(job.next_slot);
    FrameSlot& slot = job.slots[index];
    slot.phase = FramePhase::opening;
    --job.waiting;
    if (!slot.books) {
      slot.books = std::make_unique<FrameState>(job.grid.order(), job.plan.batches);
    }
    job.in_flight.push_back(index);
    say(OpenFrame{job.id, slot.frame});
  }
}

void Scheduler::complete_if_so(JobState& job, FrameSlot& slot) {
  if (slot.phase == FramePhase::rendering && slot.books->complete()) finish(job, slot);
}

void Scheduler::finish(JobState& job, FrameSlot& slot) {
  // Late films may have overtaken units that are still out.
  take_back_frame(job, slot);
  slot.phase = FramePhase::finishing;
  say(FinishFrame{job.id, slot.frame});
}

void Scheduler::fail_frame(JobState& job, FrameSlot& slot, std::string reason) {
  slot.phase = FramePhase::closing;
  slot.reason = std::move(reason);
  take_back_frame(job, slot);
  slot.books.reset();
  update_ready(job);
  persist(FrameFailedRecord{job.id, {slot.frame, slot.reason}}, {});
}

/// What is on its way to the disk of this frame's films is durable before the record, and void.
void Scheduler::restart_frame(JobState& job, FrameSlot& slot) {
  slot.phase = FramePhase::restarting;
  take_back_frame(job, slot);
  slot.books.reset();
  update_ready(job);
  persist(FrameRestartedRecord{job.id, slot.frame}, {});
}

/// The same for a frame that has films from before a restart and was not opened since.
void Scheduler::restart_waiting(JobState& job, uint32_t slot) {
  --job.waiting;
  job.in_flight.push_back(slot);
  restart_frame(job, job.slots[slot]);
}

void Scheduler::frame_restarted(JobState& job, FrameSlot& slot) {
  const auto index = static_cast<uint32_t>(&slot - job.slots.data());
  slot.phase = FramePhase::waiting;
  ++job.waiting;
  slot.worker_class = 0;
  slot.orphaned.reset();
  slot.finish_attempts = 0;
  slot.reason.clear();
  std::erase(job.in_flight, index);
  job.next_slot = std::min<size_t>(job.next_slot, index);
  say(FrameRestarted{job.id, slot.frame});
  open_frames(job);
}

/// Frames whose class has been gone for too long begin again, if there is somebody to render them.
void Scheduler::restart_orphans() {
  if (options_.class_patience <= Duration{0} || now_ < next_orphan_check_) return;
  next_orphan_check_ = now_ + options_.class_patience / 4;
  if (threads_ == 0) return;
  for (const auto& [id, job] : jobs_) {
    if (job->paused) continue;
    const std::vector<uint32_t> in_flight = job->in_flight;
    for (const uint32_t i : in_flight) {
      FrameSlot& slot = job->slots[i];
      const uint32_t c = slot.worker_class;
      if (slot.phase != FramePhase::rendering || c == 0) continue;
      if (class_workers_[c] > 0 && anybody_for(*job, c)) {
        slot.orphaned.reset();
        continue;
      }
      if (!slot.orphaned) slot.orphaned = class_workers_[c] > 0 ? now_ : class_gone_[c];
      if (now_ < *slot.orphaned + options_.class_patience || slot.books->all_held()) continue;
      restart_frame(*job, slot);
    }
  }
}

void Scheduler::take_back_frame(JobState& job, FrameSlot& slot) {
  if (!slot.books || !slot.books->any_assigned()) return;
  const auto index = static_cast<uint32_t>(&slot - job.slots.data());
  std::vector<uint64_t> numbers;
  for (const auto& [number, lease] : leases_) {
    if (lease.job == job.id && lease.slot == index) numbers.push_back(number);
  }
  std::sort(numbers.begin(), numbers.end());
  for (const uint64_t number : numbers) release_lease(number, true);
}

void Scheduler::frame_over(JobState& job, FrameSlot& slot, FramePhase phase) {
  slot.phase = phase;
  slot.books.reset();
  std::erase(job.in_flight, static_cast<uint32_t>(&slot - job.slots.data()));
  if (phase == FramePhase::done) {
    ++job.frames_done;
    say(FrameDone{job.id, slot.frame});
  } else {
    ++job.frames_failed;
    say(FrameFailed{job.id, slot.frame, slot.reason});
  }
  open_frames(job);
  end_job_if_over(job);
}

void Scheduler::end_job_if_over(JobState& job) {
  if (job.frames_done + job.frames_failed < job.slots.size()) return;
  update_ready(job);
  say(JobEnded{job.id, job.frames_done, job.frames_failed, false});
  marked_.erase(job.id);
  jobs_.erase(job.id);
}

JobState* Scheduler::find_job(JobId id) {
  const auto it = jobs_.find(id);
  return it == jobs_.end() ? nullptr : it->second.get();
}

Scheduler::Worker* Scheduler::find_worker(WorkerId id) {
  const auto it = workers_.find(id);
  return it == workers_.end() ? nullptr : &it->second;
}

std::optional<Extent> Scheduler::extent_of(const JobState& job, const core::Unit& unit) const {
  const auto tile = job.grid.index_of(unit.tile);
  const uint64_t end = uint64_t{unit.batches.first} + unit.batches.count;
  if (!tile || unit.batches.count == 0 || end > job.plan.batches) return std::nullopt;
  return Extent{*tile, unit.batches};
}

core::Unit Scheduler::unit_of(const JobState& job, const FrameSlot& slot,
                              const Extent& extent) const {
  return {slot.frame, job.grid.tile(extent.tile), extent.batches};
}

uint32_t Scheduler::share_of(int priority, const std::string& owner) {
  const auto [it, fresh] =
      share_index_.try_emplace({priority, owner}, static_cast<uint32_t>(shares_.size()));
  if (fresh) shares_.push_back({priority, owner, 0, {}});
  return it->second;
}

void Scheduler::set_running(JobState& job, int64_t change) {
  job.running += static_cast<uint64_t>(change);
  const uint32_t index = job.share;
  Share& share = shares_[index];
  if (!share.ready.empty()) ready_shares_.erase({-share.priority, share.running, index});
  share.running += static_cast<uint64_t>(change);
  if (!share.ready.empty()) ready_shares_.insert({-share.priority, share.running, index});
}

/// Lists the job among those that have work, or takes it off the list. Those who wait are served
/// again only where there is more than before: what was there did not suit them.
void Scheduler::update_ready(JobState& job) {
  uint64_t offer = 0;
  for (const uint32_t i : job.in_flight) {
    const FrameSlot& slot = job.slots[i];
    if (job.paused || slot.phase != FramePhase::rendering) continue;
    offer += slot.books->free() + slot.books->waiting_checks();
  }
  if (offer > job.offer) work_appeared_ = true;
  offered_ += offer - job.offer;
  job.offer = offer;
  list_ready(job, offer > 0);
}

void Scheduler::list_ready(JobState& job, bool ready) {
  if (ready == job.ready) return;
  job.ready = ready;
  Share& share = shares_[job.share];
  if (ready) {
    share.ready.emplace(job.serial, &job);
    if (share.ready.size() == 1) {
      ready_shares_.insert({-share.priority, share.running, job.share});
    }
  } else {
    share.ready.erase(job.serial);
    if (share.ready.empty()) ready_shares_.erase({-share.priority, share.running, job.share});
  }
}

uint32_t Scheduler::intern_class(const std::string& name) {
  const auto [it, fresh] =
      class_index_.try_emplace(name, static_cast<uint32_t>(class_names_.size()));
  if (fresh) {
    class_names_.push_back(name);
    class_workers_.push_back(0);
    class_gone_.push_back(now_);
  }
  return it->second;
}

std::vector<uint32_t> Scheduler::intern_tags(const std::vector<std::string>& tags) {
  std::vector<uint32_t> numbers;
  for (const std::string& tag : tags) {
    const auto next = static_cast<uint32_t>(tag_index_.size());
    numbers.push_back(tag_index_.try_emplace(tag, next).first->second);
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// Whether a worker of the class may get units of the job.
bool Scheduler::anybody_for(const JobState& job, uint32_t worker_class) const {
  if (!job.plan.needs.any()) return class_workers_[worker_class] > 0;
  return std::any_of(workers_.begin(), workers_.end(), [&](const auto& entry) {
    return !entry.second.barred && entry.second.worker_class == worker_class &&
           suits(job, entry.second);
  });
}

Scheduler::LeaseState* Scheduler::find_lease(const LeaseId& id) {
  if (id.incarnation != options_.incarnation) return nullptr;
  const auto it = leases_.find(id.number);
  return it == leases_.end() ? nullptr : &it->second;
}

std::optional<TimePoint> Scheduler::next_wake() const {
  std::optional<TimePoint> wake;
  const auto at = [&](TimePoint t) { wake = wake ? std::min(*wake, t) : t; };
  if (!deadlines_.empty()) at(deadlines_.top().first);
  if (now_ < storage_blocked_until_) at(storage_blocked_until_);
  if (turned_away_) at(now_ + kLookAgain);
  if (options_.class_patience > Duration{0} && !jobs_.empty() && threads_ > 0) {
    at(next_orphan_check_);
  }
  if (!leasing_held_ && !waiting_.empty() && !copy_candidates_.empty() &&
      options_.copy_after > Duration{0}) {
    at(std::max(copy_candidates_.front().since + options_.copy_after, next_copy_round_));
  }
  return wake;
}

uint32_t Scheduler::leased_units(JobId id) const {
  const auto job = jobs_.find(id);
  return job == jobs_.end() ? 0 : static_cast<uint32_t>(job->second->running);
}

uint32_t Scheduler::disputed_units(JobId id) const {
  const auto job = jobs_.find(id);
  if (job == jobs_.end()) return 0;
  size_t units = 0;
  for (const uint32_t i : job->second->in_flight) {
    const FrameSlot& slot = job->second->slots[i];
    if (slot.books) units += slot.books->disputes();
  }
  return static_cast<uint32_t>(units);
}

uint32_t Scheduler::leased_units(WorkerId id) const {
  const auto worker = workers_.find(id);
  if (worker == workers_.end()) return 0;
  size_t units = 0;
  for (const uint64_t number : worker->second.leases) units += leases_.at(number).units.size();
  return static_cast<uint32_t>(units);
}

std::vector<UnitInHand> Scheduler::units_of(WorkerId worker, const LeaseId& lease) const {
  std::vector<UnitInHand> units;
  const auto found = leases_.find(lease.number);
  if (lease.incarnation != options_.incarnation || found == leases_.end() ||
      found->second.worker != worker) {
    return units;
  }
  const JobState& job = *jobs_.at(found->second.job);
  for (const Extent& extent : found->second.units) {
    units.push_back({lease, job.id, unit_of(job, job.slots[found->second.slot], extent)});
  }
  return units;
}

std::string Scheduler::audit() const {
  std::map<std::pair<JobId, uint32_t>, size_t> out;
  for (const auto& [number, lease] : leases_) {
    if (lease.units.empty()) return fmt::format("lease {} holds nothing", number);
    const auto worker = workers_.find(lease.worker);
    if (worker == workers_.end() ||
        std::count(worker->second.leases.begin(), worker->second.leases.end(), number) != 1) {
      return fmt::format("lease {} is not on its worker's list", number);
    }
    const auto job = jobs_.find(lease.job);
    if (job == jobs_.end()) return fmt::format("lease {} belongs to no job", number);
    const FrameSlot& slot = job->second->slots[lease.slot];
    if (!slot.books) return fmt::format("lease {} belongs to a frame that is over", number);
    for (const Extent& e : lease.units) {
      const Assignment* a = slot.books->find_assignment(e);
      if (a == nullptr) return fmt::format("lease {} holds a unit that nobody is assigned", number);
      out[{lease.job, lease.slot}] += 1;
    }
  }
  std::vector<uint64_t> running(shares_.size());
  for (const auto& [id, job] : jobs_) {
    for (uint32_t i = 0; i < job->slots.size(); ++i) {
      const FrameSlot& slot = job->slots[i];
      const auto units = out.find({id, i});
      const size_t leased = units == out.end() ? 0 : units->second;
      running[job->share] += leased;
      const bool listed = std::count(job->in_flight.begin(), job->in_flight.end(), i) == 1;
      if (listed != slot.in_flight())
        return fmt::format("frame {} is in the wrong list", slot.frame);
      if (!slot.books) continue;
      if (slot.books->holders() != leased) {
        return fmt::format("frame {}: {} units assigned, {} leased", slot.frame,
                           slot.books->holders(), leased);
      }
      if (std::string wrong = slot.books->audit(); !wrong.empty()) {
        return fmt::format("frame {}: {}", slot.frame, wrong);
      }
    }
  }
  for (size_t i = 0; i < shares_.size(); ++i) {
    if (shares_[i].running != running[i]) return "an owner's running units are miscounted";
  }
  return {};
}

}  // namespace hyades::coordinator
