#include "coordinator/scheduler/hedged_copies.h"

#include <algorithm>
#include <chrono>
#include <vector>

namespace hyades::coordinator {
namespace {

/// How many of the oldest units are considered before a worker goes without a copy.
constexpr size_t kCopySearch = 16;
/// A unit is late when it has been out for that many times what it should take (it may have waited
/// for another, on a slow machine), and a little for the way there and back.
constexpr double kLate = 3;
constexpr Duration kWay = std::chrono::seconds(1);
/// How often the waiting workers are offered copies.
constexpr Duration kCopyRound = std::chrono::milliseconds(250);

}  // namespace

bool HedgedCopies::grant(WorkerId id, Worker& worker) {
  if (!enabled()) return false;
  const auto is_over = [&](const Candidate& c) { return find(c) == nullptr; };
  while (!alone_.empty() && (is_over(alone_.front()) || find(alone_.front())->holders.size() > 1)) {
    alone_.pop_front();
  }
  while (!copied_.empty() && is_over(copied_.front())) copied_.pop_front();
  return grant_of(alone_, 1, id, worker) || grant_of(copied_, 2, id, worker);
}

/// Whether one more worker may render the unit, that is not one of those who have it. Where two of
/// one origin do, both may hold it for ever: another may too, then.
bool HedgedCopies::may_copy(const Assignment& assignment, WorkerId id, const Worker& worker) const {
  const std::vector<Holder>& holders = assignment.holders;
  if (holders.size() == 1) return holders.front().worker != id;
  if (holders.size() != 2) return false;
  const Worker* first = workers_.find(holders[0].worker);
  const Worker* second = workers_.find(holders[1].worker);
  return first != nullptr && second != nullptr && first->origin == second->origin &&
         first->origin != worker.origin;
}

/// Of those that at most so many workers have.
bool HedgedCopies::grant_of(const Candidates& candidates, size_t holders, WorkerId id,
                            Worker& worker) {
  for (size_t i = 0; i < std::min(kCopySearch, candidates.size()); ++i) {
    const Candidate candidate = candidates[i];
    if (step_.now < first_copy(candidate)) return false;
    Assignment* assignment = find(candidate);
    if (assignment == nullptr || assignment->holders.size() > holders) continue;
    if (!may_copy(*assignment, id, worker)) continue;
    const FramePlace place{jobs_.find(candidate.job), candidate.slot};
    const ScheduledJob& job = *place.job;
    if (job.paused || place.frame().worker_class != worker.worker_class) continue;
    if (!ScheduledWorkers::may_join(job, id, worker)) continue;
    const FrameLedger& ledger = *place.frame().ledger;
    // What is checked is for those who were not heard.
    const std::vector<Voice> heard = ledger.heard(candidate.extent);
    if (std::find(heard.begin(), heard.end(), worker.voice) != heard.end()) continue;
    if (!workers_.may_try(job, id, worker, ledger.blamed(candidate.extent), heard)) continue;
    const double late = seconds(step_.now - candidate.since) - late_after(job, candidate.extent);
    if (late < 0) continue;
    // Those who have the scene come first; whoever has to load it takes one copy.
    const FrameId frame = place.id();
    const bool there = Affinity::has_scene(worker, frame);
    const bool loads = affinity_.still_loads(worker) && worker.loading->frame == frame;
    const bool ready = there && !loads;
    if (!ready && (late < affinity_.load_seconds(job) || !worker.leases.empty())) continue;
    if (!there) affinity_.begin_loading(worker, frame, true);
    leases_.copy(*assignment, id);
    --worker.wanted;
    Affinity::remember_scene(worker, frame, false);
    leases_.grant(id, worker, place, {candidate.extent});
    // Who comes by another token may come later.
    if (holders == 1) {
      copied_.push_back(
          {step_.now, candidate.serial, candidate.job, candidate.slot, candidate.extent});
    }
    return true;
  }
  return false;
}

/// Before that no copy of the unit is made, however little it should take.
TimePoint HedgedCopies::first_copy(const Candidate& candidate) const {
  return candidate.since + std::min(options_.copy_after, kWay);
}

/// After what time the unit is late [s].
double HedgedCopies::late_after(const ScheduledJob& job, const Extent& extent) const {
  const double batch = job.batch_seconds(extent.tile);
  const double most = seconds(options_.copy_after);
  if (batch <= 0) return most;
  return std::min(most, seconds(kWay) + kLate * batch * extent.batches.count);
}

void HedgedCopies::note(const FramePlace& place, const Assignment& assignment) {
  if (!enabled()) return;
  if (alone_.size() >= swept_at_) {
    const auto is_over = [&](const Candidate& c) { return find(c) == nullptr; };
    std::erase_if(alone_, is_over);
    std::erase_if(copied_, is_over);
    swept_at_ = std::max<size_t>(64, 2 * alone_.size());
  }
  alone_.push_back(
      {assignment.since, assignment.serial, place.job->id, place.slot, assignment.extent});
}

bool HedgedCopies::due() const {
  const auto is_due = [this](const Candidates& candidates) {
    return !candidates.empty() && first_copy(candidates.front()) <= step_.now;
  };
  return is_due(alone_) || is_due(copied_);
}

bool HedgedCopies::begin_round() {
  if (!enabled() || step_.now < next_round_) return false;
  next_round_ = step_.now + kCopyRound;
  return true;
}

std::optional<TimePoint> HedgedCopies::next_wake() const {
  std::optional<TimePoint> wake;
  for (const Candidates* candidates : {&alone_, &copied_}) {
    if (!enabled() || candidates->empty()) continue;
    const TimePoint first = std::max(first_copy(candidates->front()), next_round_);
    wake = wake ? std::min(*wake, first) : first;
  }
  return wake;
}

/// Who has the unit, or null where that is over.
Assignment* HedgedCopies::find(const Candidate& c) const {
  ScheduledJob* job = jobs_.find(c.job);
  if (job == nullptr || !job->slots[c.slot].ledger) return nullptr;
  Assignment* assignment = job->slots[c.slot].ledger->find_assignment(c.extent);
  return assignment == nullptr || assignment->serial != c.serial ? nullptr : assignment;
}

}  // namespace hyades::coordinator
