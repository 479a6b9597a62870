// Scenes that workers have in memory: who stays with which, and who begins with another.
#include <algorithm>
#include <utility>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {
namespace {

/// Scenes that a worker is taken to have in memory. Where it has fewer, it loads one again.
constexpr size_t kScenesKept = 3;
/// A worker begins with a scene where that many times what loading takes is left to render for
/// every thread: then loading costs little though nothing hides it.
constexpr double kWorthLoading = 15;
/// The next scene is loaded when that many times what loading takes is left of this one.
constexpr double kLoadAhead = 2;
/// Some take longer than the others.
constexpr double kLoadTime = 1.5;
constexpr double kUnknownCost = 0.125;  ///< of a batch, in what a unit shall take
/// [s]; one film that came late for another reason says no more than that.
constexpr double kLongestLoad = 12;

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

bool Scheduler::has_scene(const Worker& worker, const Scene& scene) {
  return std::find(worker.scenes.begin(), worker.scenes.end(), scene) != worker.scenes.end();
}

/// The worker will have this frame's scene in memory; it keeps a few, the one that it renders last
/// in the list.
void Scheduler::remember_scene(Worker& worker, const Scene& scene, bool ahead) {
  const auto there = std::find(worker.scenes.begin(), worker.scenes.end(), scene);
  if (there != worker.scenes.end()) {
    if (!ahead) std::rotate(there, there + 1, worker.scenes.end());
    return;
  }
  if (worker.scenes.size() == kScenesKept) worker.scenes.erase(worker.scenes.begin());
  worker.scenes.insert(worker.scenes.end() - (ahead && !worker.scenes.empty() ? 1 : 0), scene);
}

/// The worker renders this frame from now on, or none.
void Scheduler::settle(Worker& worker, const std::optional<Scene>& scene) {
  if (worker.next == scene || !scene) come_next(worker, std::nullopt);
  if (worker.home == scene) return;
  if (FrameSlot* old = slot_of(worker.home)) old->crew -= worker.threads;
  worker.home = scene;
  if (FrameSlot* slot = slot_of(scene)) slot->crew += worker.threads;
}

/// The worker has a unit of this frame, so that its scene is there when it goes there.
void Scheduler::come_next(Worker& worker, const std::optional<Scene>& scene) {
  if (FrameSlot* old = slot_of(worker.next)) old->coming -= worker.threads;
  worker.next = scene;
  if (FrameSlot* slot = slot_of(scene)) slot->coming += worker.threads;
}

FrameSlot* Scheduler::slot_of(const std::optional<Scene>& scene) {
  JobState* job = scene ? find_job(scene->first) : nullptr;
  return job == nullptr ? nullptr : job->slot(scene->second);
}

/// What it takes to load a scene of the job [s].
double Scheduler::load_seconds(const JobState& job) const {
  if (job.load_seconds >= 0) return job.load_seconds;
  return load_seconds_ >= 0 ? load_seconds_ : seconds(options_.scene_time);
}

/// What is left to lease of the frame for each of `threads` [s].
double Scheduler::seconds_left(const Place& place, uint64_t threads) const {
  const JobState& job = *place.job;
  const double cost =
      job.mean_cost > 0 ? job.mean_cost : kUnknownCost * seconds(options_.unit_time);
  return static_cast<double>(job.slots[place.slot].books->free()) * cost /
         static_cast<double>(std::max<uint64_t>(threads, 1));
}

/// Whether the frame has workers enough, so that one more had better begin with another.
bool Scheduler::crowded(const Place& place, const Worker& worker) const {
  const FrameSlot& slot = place.job->slots[place.slot];
  const uint64_t threads = slot.crew + slot.coming;
  return threads > 0 &&
         seconds_left(place, threads + worker.threads) < kWorthLoading * load_seconds(*place.job);
}

/// Whether more workers may begin with the frame, and some more that come meanwhile.
bool Scheduler::has_room(const Place& place) const {
  const FrameSlot& slot = place.job->slots[place.slot];
  const uint64_t threads = slot.crew + slot.coming;
  return seconds_left(place, threads + threads / 4) > kWorthLoading * load_seconds(*place.job);
}

/// Whether those who have the frame's scene will have leased all of it before another has loaded
/// it. Not where they cannot, or do not.
bool Scheduler::too_late(const Place& place, const Worker& worker) const {
  const FrameSlot& slot = place.job->slots[place.slot];
  const uint64_t threads = slot.crew + slot.coming;
  const double load = load_seconds(*place.job);
  return threads > 0 && load_seconds_ >= 0 &&
         seconds_left(place, threads + worker.threads) < load &&
         seconds(now_ - slot.last_leased) < load && !slot.books->any_suspect() &&
         slot.books->settled();
}

/// Whether it is time to load what comes after this frame.
bool Scheduler::nearly_leased(const Place& place) const {
  const FrameSlot& slot = place.job->slots[place.slot];
  return seconds_left(place, slot.crew) < kLoadAhead * load_seconds(*place.job);
}

/// Whether the worker still loads what it last began with.
bool Scheduler::still_loads(const Worker& worker) const {
  return worker.loading && !worker.leases.empty() &&
         seconds(now_ - worker.loading->since) < kLoadTime * std::max(load_seconds_, 0.0);
}

/// A frame out of turn whose scene the worker has. Bounded in three ways, so that nobody starves:
/// the priority is that of `first`, the owner has not much more than the one who is in turn, and
/// after `affinity_time` the worker takes what is in turn. While it `loads` that scene, only the
/// priority counts.
std::optional<Scheduler::Place> Scheduler::find_loaded(WorkerId id, const Worker& worker,
                                                       const JobState& first, bool loads) {
  if (!loads && now_ - worker.in_turn >= options_.affinity_time) return std::nullopt;
  const Share& turn = shares_[first.share];
  const uint64_t most = turn.running + turn.running / 4 + 2 * uint64_t{worker.threads};
  for (auto scene = worker.scenes.rbegin(); scene != worker.scenes.rend(); ++scene) {
    JobState* job = find_job(scene->first);
    if (job == nullptr || !job->ready || job->plan.order != FrameOrder::sequential) continue;
    const Share& share = shares_[job->share];
    if (share.priority != turn.priority || (!loads && share.running > most)) continue;
    if (!may_join(*job, id, worker)) continue;
    const FrameSlot* slot = job->slot(scene->second);
    if (!has_work_for(*job, *slot, id, worker)) continue;
    return Place{job, static_cast<uint32_t>(slot - job->slots.data())};
  }
  return std::nullopt;
}

/// The scene is there. Where a worker had nothing else to do, what its first unit did not take to
/// render went into loading.
void Scheduler::learn_load(JobState& job, Worker& worker, const ResultArrived& e) {
  if (!worker.loading || worker.loading->scene != Scene{e.job, e.unit.frame}) return;
  const Loading loading = *std::exchange(worker.loading, std::nullopt);
  if (!loading.alone || e.render_time <= Duration{0} || options_.scene_time <= Duration{0}) return;
  const double load = std::clamp(seconds(now_ - loading.since - e.render_time), 0.0, kLongestLoad);
  const auto learn = [&](double& known) { known = known < 0 ? load : 0.9 * known + 0.1 * load; };
  learn(job.load_seconds);
  learn(load_seconds_);
}

}  // namespace hyades::coordinator
