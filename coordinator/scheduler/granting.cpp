// Which unit a worker gets next.
#include <algorithm>
#include <bit>
#include <functional>
#include <utility>

#include "coordinator/scheduler/run_length.h"
#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {
namespace {

/// How many frames of an owner's are considered that have workers enough.
constexpr size_t kPlacesLookedAt = 12;

/// Which doubling of its samples a frame is in: 0 until every tile has had one batch, p until every
/// tile has had 2^p.
uint32_t pass_of(const FrameState& books, uint32_t tiles) {
  return static_cast<uint32_t>(std::bit_width((books.total() - books.free()) / tiles));
}

}  // namespace

/// Where the worker has a scene of another frame in memory it may stay with that one, within
/// bounds. A scene that it does not have begins with one unit, which waits while the worker goes on
/// with what it has.
bool Scheduler::grant(WorkerId id, Worker& worker) {
  const auto first = in_turn(id, worker, false);
  if (!first) return false;
  const bool fresh = !has_scene(worker, first->scene());
  const bool loads = worker.next == first->scene() && still_loads(worker);
  const bool here = !fresh && !loads;
  const auto loaded = here ? std::nullopt : find_loaded(id, worker, *first->job, loads);
  if (!loaded) worker.in_turn = now_;
  if (fresh && !loaded && options_.scene_time > Duration{0} &&
      find_loaded(id, worker, *first->job, true)) {
    return grant_from(*first, id, worker, true);
  }
  const Place place = loaded.value_or(*first);
  if (place.scene() == worker.home && !worker.next && nearly_leased(place)) {
    const auto next = in_turn(id, worker, true);
    if (next && grant_from(*next, id, worker, true)) return true;
  }
  return grant_from(place, id, worker, false);
}

/// Priorities first, then who has less, then the older job, then the earlier frame: what is first
/// in turn for this worker. A frame that has workers enough is in turn for those who have its scene
/// only; where all have, the one with most to do is. `fresh`: of the scenes that the worker does
/// not have.
std::optional<Scheduler::Place> Scheduler::in_turn(WorkerId id, const Worker& worker, bool fresh) {
  // Where a frame waits for room for its film none behind it begins, so that a large one gets some.
  bool begun = false;
  for (const auto& [priority, running, index] : ready_shares_) {
    std::optional<Place> roomiest;
    double most = -1;
    size_t looked = 0;
    for (const auto& [serial, job] : shares_[index].ready) {
      if (looked == kPlacesLookedAt) break;
      if (!may_join(*job, id, worker)) continue;
      if (job->plan.order == FrameOrder::progressive) {
        const auto slot = find_pass(*job, id, worker, begun);
        if (slot && !(fresh && has_scene(worker, Place{job, *slot}.scene()))) {
          return Place{job, *slot};
        }
        continue;
      }
      for (const uint32_t slot : job->in_flight) {
        const Place place{job, slot};
        const FrameSlot& frame = job->slots[slot];
        if (frame.phase == FramePhase::rendering && !frame.film) {
          begun = begun || !film_fits(*job, frame);
          if (begun) continue;
        }
        if (!has_work_for(*job, job->slots[slot], id, worker)) continue;
        const bool here = has_scene(worker, place.scene());
        if (here && fresh) continue;
        if (!here && still_loads(worker)) {
          // Scenes are loaded one after the other.
          turned_away_ = true;
          continue;
        }
        if (here || !crowded(place, worker)) return place;
        if (too_late(place, worker)) {
          turned_away_ = true;
          continue;
        }
        const uint64_t threads = job->slots[slot].crew + job->slots[slot].coming;
        const double left = seconds_left(place, threads + worker.threads);
        if (left > most) {
          most = left;
          roomiest = place;
        }
        if (++looked == kPlacesLookedAt) break;
      }
    }
    if (roomiest) return roomiest;
  }
  return std::nullopt;
}

/// Whether the worker could render units of the job at all.
bool Scheduler::suits(const JobState& job, const Worker& worker) {
  const uint64_t memory = job.plan.needs.memory;
  return (memory == 0 || worker.memory == 0 || worker.memory >= memory) &&
         std::includes(worker.tags.begin(), worker.tags.end(), job.tags.begin(), job.tags.end());
}

/// Whether there is something of the frame for this worker.
bool Scheduler::has_work_for(const JobState& job, const FrameSlot& slot, WorkerId id,
                             const Worker& worker) const {
  if (slot.phase != FramePhase::rendering || !film_fits(job, slot)) return false;
  if (slot.worker_class != 0 && slot.worker_class != worker.worker_class) return false;
  const auto judge = [&](const std::vector<WorkerId>& blamed) {
    return may_try(job, id, worker, blamed);
  };
  const MayTry allowed = std::ref(judge);
  return slot.books->has_work(allowed) || slot.books->next_check(id, allowed).has_value();
}

/// Of a progressive job, the frame in the lowest pass; `begun`: of those that have begun.
std::optional<uint32_t> Scheduler::find_pass(const JobState& job, WorkerId id, const Worker& worker,
                                             bool begun) const {
  std::optional<uint32_t> best;
  uint32_t best_pass = 0;
  for (const uint32_t index : job.in_flight) {
    if (begun && !job.slots[index].film) continue;
    if (!has_work_for(job, job.slots[index], id, worker)) continue;
    const uint32_t pass = pass_of(*job.slots[index].books, job.grid.size());
    if (best && pass >= best_pass) continue;
    best = index;
    best_pass = pass;
  }
  return best;
}

/// Units of one frame, as many as the worker wants and the frame has; `ahead`: one, so that its
/// scene is loaded while the worker is busy with another.
bool Scheduler::grant_from(const Place& place, WorkerId id, Worker& worker, bool ahead) {
  JobState& job = *place.job;
  FrameSlot& slot = job.slots[place.slot];
  const auto judge = [&](const std::vector<WorkerId>& blamed) {
    return may_try(job, id, worker, blamed);
  };
  const MayTry allowed = std::ref(judge);
  if (!has_scene(worker, place.scene())) {
    worker.loading = Loading{place.scene(), now_, worker.leases.empty()};
  }
  remember_scene(worker, place.scene(), ahead);
  if (ahead) {
    come_next(worker, place.scene());
  } else {
    settle(worker, place.scene());
  }
  slot.last_leased = now_;
  if (grant_check(job, place.slot, id, worker, allowed)) return true;
  std::vector<Extent> extents;
  const LeaseId next{options_.incarnation, next_lease_};
  while (extents.size() < (ahead ? 1 : worker.wanted)) {
    const auto extent = slot.books->next(
        allowed, [&](uint32_t tile) { return run_length_of(job, *slot.books, tile); });
    if (!extent) break;
    note_copy_candidate(job, place.slot,
                        slot.books->assign(*extent, {id, next}, next_assignment_++));
    extents.push_back(*extent);
  }
  if (extents.empty()) return false;
  slot.worker_class = worker.worker_class;
  worker.wanted -= static_cast<uint32_t>(extents.size());
  new_lease(id, worker, job, place.slot, false, std::move(extents));
  update_ready(job);
  open_frames(job);
  return true;
}

/// What a batch of the tile takes one thread, as far as is known [s]; 0: nothing is known.
double Scheduler::batch_seconds(const JobState& job, uint32_t tile) {
  return job.tile_cost[tile] > 0 ? job.tile_cost[tile] : job.mean_cost;
}

uint32_t Scheduler::run_length_of(const JobState& job, const FrameState& books,
                                  uint32_t tile) const {
  const double cost = batch_seconds(job, tile);
  if (cost <= 0) return 1;
  uint64_t left = std::max(offered_, books.free());
  if (job.in_flight.size() < job.plan.frames_in_flight) {
    left += job.waiting * books.total();
  }
  uint64_t run = run_length(cost, options_.unit_time, left, threads_);
  if (job.plan.order == FrameOrder::progressive) {
    // No tile gets ahead of its frame's pass.
    const uint32_t pass = pass_of(books, job.grid.size());
    run = std::min(run, uint64_t{1} << std::min(pass == 0 ? 0 : pass - 1, 31U));
  }
  return static_cast<uint32_t>(run);
}

/// A unit that has failed goes to somebody who has not failed it yet, if there is anybody.
bool Scheduler::may_try(const JobState& job, WorkerId id, const Worker& worker,
                        const std::vector<WorkerId>& blamed) const {
  return std::find(blamed.begin(), blamed.end(), id) == blamed.end() ||
         !anybody_besides(blamed, job, worker.worker_class);
}

/// Whether a worker of the class is there that may get units of the job and is none of `tried`.
bool Scheduler::anybody_besides(const std::vector<WorkerId>& tried, const JobState& job,
                                uint32_t worker_class) const {
  return std::any_of(workers_.begin(), workers_.end(), [&](const auto& entry) {
    return !entry.second.barred && entry.second.worker_class == worker_class &&
           suits(job, entry.second) &&
           std::find(tried.begin(), tried.end(), entry.first) == tried.end();
  });
}

}  // namespace hyades::coordinator
