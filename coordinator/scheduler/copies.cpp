// Second copies of units that are late, for workers that have nothing else to do.
#include <algorithm>
#include <utility>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {
namespace {

/// How many of the oldest units are considered before a worker goes without a copy.
constexpr size_t kCopySearch = 16;
/// A unit is late when it has been out for that many times what it should take (it may have waited
/// for another, on a slow machine), and a little for the way there and back.
constexpr double kLate = 3;
constexpr Duration kWay = std::chrono::seconds(1);

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

/// Hands out a second copy of one of the oldest units that are late: purity makes it safe, and
/// whichever comes first counts. No unit is copied twice.
bool Scheduler::grant_copy(WorkerId id, Worker& worker) {
  if (options_.copy_after <= Duration{0}) return false;
  while (!copy_candidates_.empty() && !live_copy_candidate(copy_candidates_.front())) {
    copy_candidates_.pop_front();
  }
  for (size_t i = 0; i < std::min(kCopySearch, copy_candidates_.size()); ++i) {
    const CopyCandidate candidate = copy_candidates_[i];
    if (now_ < first_copy(candidate)) return false;
    Assignment* assignment = live_copy_candidate(candidate);
    if (assignment == nullptr || assignment->holders.front().worker == id) continue;
    JobState& job = *find_job(candidate.job);
    if (job.paused || job.slots[candidate.slot].worker_class != worker.worker_class) continue;
    if (!may_join(job, id, worker)) continue;
    const FrameState& books = *job.slots[candidate.slot].books;
    if (!may_try(job, id, worker, books.blamed(candidate.extent))) continue;
    const double late = seconds(now_ - candidate.since) - late_after(job, candidate.extent);
    if (late < 0) continue;
    // Those who have the scene come first; whoever has to load it takes one copy.
    const Scene scene{job.id, job.slots[candidate.slot].frame};
    const bool loads = still_loads(worker) && worker.loading->scene == scene;
    const bool ready = has_scene(worker, scene) && !loads;
    if (!ready && (late < load_seconds(job) || !worker.leases.empty())) continue;
    if (!has_scene(worker, scene)) worker.loading = Loading{scene, now_, true};
    assignment->copied = true;
    assignment->holders.push_back({id, {options_.incarnation, next_lease_}});
    --worker.wanted;
    remember_scene(worker, scene, false);
    new_lease(id, worker, job, candidate.slot, false, {candidate.extent});
    return true;
  }
  return false;
}

/// Before that no copy of the unit is made, however little it should take.
TimePoint Scheduler::first_copy(const CopyCandidate& candidate) const {
  return candidate.since + std::min(options_.copy_after, kWay);
}

/// After what time the unit is late [s].
double Scheduler::late_after(const JobState& job, const Extent& extent) const {
  const double batch = batch_seconds(job, extent.tile);
  const double most = seconds(options_.copy_after);
  if (batch <= 0) return most;
  return std::min(most, seconds(kWay) + kLate * batch * extent.batches.count);
}

void Scheduler::note_copy_candidate(const JobState& job, uint32_t slot,
                                    const Assignment& assignment) {
  if (options_.copy_after <= Duration{0}) return;
  if (copy_candidates_.size() >= copy_candidates_checked_) {
    std::erase_if(copy_candidates_,
                  [&](const CopyCandidate& c) { return !live_copy_candidate(c); });
    copy_candidates_checked_ = std::max<size_t>(64, 2 * copy_candidates_.size());
  }
  copy_candidates_.push_back({now_, assignment.serial, job.id, slot, assignment.extent});
}

/// The assignment that may still be copied, or null.
Assignment* Scheduler::live_copy_candidate(const CopyCandidate& c) {
  JobState* job = find_job(c.job);
  if (job == nullptr || !job->slots[c.slot].books) return nullptr;
  Assignment* assignment = job->slots[c.slot].books->find_assignment(c.extent);
  if (assignment == nullptr || assignment->serial != c.serial || assignment->copied) return nullptr;
  return assignment;
}

}  // namespace hyades::coordinator
