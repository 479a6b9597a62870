#include "coordinator/scheduler/hedged_copies.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace hyades::coordinator {
namespace {

/// How many of the oldest units of a job are considered before a worker goes without a copy of one.
constexpr size_t kCopySearch = 64;
/// A unit is late when it has been out for that many times what it should take (it may have waited
/// for another, on a slow machine), and a little for the way there and back.
constexpr double kLate = 3;
constexpr Duration kWay = std::chrono::seconds(1);
/// Of how many jobs a worker is offered units at a time.
constexpr size_t kGroupsOffered = 64;
/// How often the waiting workers are offered copies.
constexpr Duration kCopyRound = std::chrono::milliseconds(250);

}  // namespace

bool HedgedCopies::grant(WorkerId id, Worker& worker) {
  if (!enabled()) return false;
  const std::vector<Units*> late = for_worker(id, worker);
  const auto grant_with = [&](size_t holders) {
    return std::any_of(late.begin(), late.end(),
                       [&](Units* units) { return grant_of(*units, holders, id, worker); });
  };
  return grant_with(1) || grant_with(2);
}

/// Those that the worker may have copies of, whoever has waited longest first.
std::vector<HedgedCopies::Units*> HedgedCopies::for_worker(WorkerId id, const Worker& worker) {
  std::vector<Units*> found;
  for (const ClassId worker_class : worker.classes) {
    const auto late = late_.find(worker_class);
    if (late == late_.end()) continue;
    const size_t others = found.size();
    for (const auto& [number, units] : late->second) {
      if (found.size() == others + kGroupsOffered || ++looks_ > kLooks) break;
      const ScheduledJob* job = jobs_.find(number);  // it may have ended
      if (job == nullptr || job->paused || !ScheduledWorkers::may_join(*job, id, worker)) continue;
      forget_over(*units);
      if (!units->empty()) found.push_back(units);
    }
    std::inplace_merge(found.begin(), found.begin() + static_cast<ptrdiff_t>(others), found.end(),
                       [](const Units* a, const Units* b) { return a->since() < b->since(); });
  }
  return found;
}

/// Drops the first ones that nobody needs a copy of any more.
void HedgedCopies::forget_over(Units& units) const {
  const auto is_over = [&](const Candidate& c, size_t holders) {
    const Assignment* assignment = find(c);
    return assignment == nullptr || assignment->holders.size() > holders;
  };
  while (!units.alone.empty() && is_over(units.alone.front(), 1)) units.alone.pop_front();
  while (!units.copied.empty() && is_over(units.copied.front(), 2)) units.copied.pop_front();
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
bool HedgedCopies::grant_of(Units& units, size_t holders, WorkerId id, Worker& worker) {
  const Candidates& candidates = holders == 1 ? units.alone : units.copied;
  for (size_t i = 0; i < std::min(kCopySearch, candidates.size()); ++i) {
    const Candidate candidate = candidates[i];
    if (step_.now < first_copy(candidate)) return false;
    Assignment* assignment = find(candidate);
    if (assignment == nullptr || assignment->holders.size() > holders) continue;
    if (!may_copy(*assignment, id, worker)) continue;
    const FramePlace place{jobs_.find(candidate.job), candidate.slot};
    const ScheduledJob& job = *place.job;
    const FrameLedger& ledger = *place.frame().ledger;
    // What is checked is for those who were not heard.
    const std::vector<Witness> heard = ledger.heard(candidate.extent);
    if (std::find(heard.begin(), heard.end(), worker.witness) != heard.end()) continue;
    if (!workers_.may_try(job, id, worker, ledger.failed().workers(candidate.extent), heard))
      continue;
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
      units.copied.push_back(
          {step_.now, candidate.serial, candidate.job, candidate.slot, candidate.extent});
      may_be_late(units.copied.back());
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

void HedgedCopies::note(const FramePlace& place, const Assignment& assignment,
                        ClassId worker_class) {
  if (!enabled()) return;
  Units& units = out_[{worker_class, place.job->id}];
  if (units.alone.size() >= units.swept_at) {
    const auto is_over = [&](const Candidate& c) { return find(c) == nullptr; };
    std::erase_if(units.alone, is_over);
    std::erase_if(units.copied, is_over);
    units.swept_at = std::max<size_t>(64, 2 * units.alone.size());
  }
  units.alone.push_back(
      {assignment.since, assignment.serial, place.job->id, place.slot, assignment.extent});
  may_be_late(units.alone.back());
}

/// Some unit may be late from some time on.
void HedgedCopies::may_be_late(const Candidate& candidate) {
  const TimePoint copy = first_copy(candidate);
  first_ = first_ ? std::min(*first_, copy) : copy;
}

bool HedgedCopies::begin_round() {
  if (!enabled() || step_.now < next_round_) return false;
  next_round_ = step_.now + kCopyRound;
  late_.clear();
  looks_ = 0;
  first_.reset();
  for (auto it = out_.begin(); it != out_.end();) {
    Units& units = it->second;
    forget_over(units);
    if (units.empty()) {
      it = out_.erase(it);
      continue;
    }
    bool late = false;
    for (const Candidates* candidates : {&units.alone, &units.copied}) {
      if (candidates->empty()) continue;
      may_be_late(candidates->front());
      late = late || first_copy(candidates->front()) <= step_.now;
    }
    if (late) late_[it->first.worker_class].emplace_back(it->first.job, &units);
    ++it;
  }
  for (auto& [worker_class, groups] : late_) {
    std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) {
      return a.second->since() < b.second->since();
    });
  }
  return true;
}

std::optional<TimePoint> HedgedCopies::next_wake() const {
  return first_ ? std::optional(std::max(*first_, next_round_)) : std::nullopt;
}

/// Who has the unit, or null where that is over.
Assignment* HedgedCopies::find(const Candidate& c) const {
  ScheduledJob* job = jobs_.find(c.job);
  if (job == nullptr || !job->slots[c.slot].ledger) return nullptr;
  Assignment* assignment = job->slots[c.slot].ledger->find_assignment(c.extent);
  return assignment == nullptr || assignment->serial != c.serial ? nullptr : assignment;
}

}  // namespace hyades::coordinator
