#include "coordinator/scheduler/affinity.h"

#include <algorithm>
#include <cstddef>
#include <utility>

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

}  // namespace

bool Affinity::has_scene(const Worker& worker, const FrameId& frame) {
  return std::find(worker.scenes.begin(), worker.scenes.end(), frame) != worker.scenes.end();
}

/// The one that it renders is the last in the list.
void Affinity::remember_scene(Worker& worker, const FrameId& frame, bool ahead) {
  const auto there = std::find(worker.scenes.begin(), worker.scenes.end(), frame);
  if (there != worker.scenes.end()) {
    if (!ahead) std::rotate(there, there + 1, worker.scenes.end());
    return;
  }
  if (worker.scenes.size() == kScenesKept) worker.scenes.erase(worker.scenes.begin());
  worker.scenes.insert(worker.scenes.end() - (ahead && !worker.scenes.empty() ? 1 : 0), frame);
}

void Affinity::begin_loading(Worker& worker, const FrameId& frame, bool alone) const {
  worker.loading = Worker::Loading{frame, step_.now, alone};
}

void Affinity::settle(Worker& worker, const std::optional<FrameId>& frame) const {
  if (worker.prefetch == frame || !frame) prefetch(worker, std::nullopt);
  if (worker.affinity == frame) return;
  if (FrameSlot* old = find(worker.affinity)) old->assigned_threads -= worker.threads;
  worker.affinity = frame;
  if (FrameSlot* slot = find(frame)) slot->assigned_threads += worker.threads;
}

void Affinity::prefetch(Worker& worker, const std::optional<FrameId>& frame) const {
  if (FrameSlot* old = find(worker.prefetch)) old->prefetching_threads -= worker.threads;
  worker.prefetch = frame;
  if (FrameSlot* slot = find(frame)) slot->prefetching_threads += worker.threads;
}

FrameSlot* Affinity::find(const std::optional<FrameId>& frame) const {
  return frame ? jobs_.find_frame(*frame).slot : nullptr;
}

double Affinity::load_seconds(const ScheduledJob& job) const {
  if (job.load_seconds >= 0) return job.load_seconds;
  return load_seconds_ >= 0 ? load_seconds_ : seconds(options_.scene_time);
}

double Affinity::seconds_left(const FramePlace& place, uint64_t threads) const {
  const ScheduledJob& job = *place.job;
  const double cost =
      job.mean_cost > 0 ? job.mean_cost : kUnknownCost * seconds(options_.unit_time);
  const FrameLedger& ledger = *place.frame().ledger;
  return static_cast<double>(ledger.free() + ledger.likely_more()) * cost /
         static_cast<double>(std::max<uint64_t>(threads, 1));
}

bool Affinity::crowded(const FramePlace& place, const Worker& worker) const {
  const uint64_t threads = place.frame().threads();
  return threads > 0 &&
         seconds_left(place, threads + worker.threads) < kWorthLoading * load_seconds(*place.job);
}

bool Affinity::has_room(const FramePlace& place) const {
  const uint64_t threads = place.frame().threads();
  return seconds_left(place, threads + threads / 4) > kWorthLoading * load_seconds(*place.job);
}

bool Affinity::too_late(const FramePlace& place, const Worker& worker) const {
  const FrameSlot& slot = place.frame();
  const uint64_t threads = slot.threads();
  const double load = load_seconds(*place.job);
  return threads > 0 && load_seconds_ >= 0 &&
         seconds_left(place, threads + worker.threads) < load &&
         seconds(step_.now - slot.last_leased) < load && !slot.ledger->any_retry() &&
         slot.ledger->settled();
}

bool Affinity::nearly_leased(const FramePlace& place) const {
  return seconds_left(place, place.frame().assigned_threads) <
         kLoadAhead * load_seconds(*place.job);
}

bool Affinity::still_loads(const Worker& worker) const {
  return worker.loading && !worker.leases.empty() &&
         seconds(step_.now - worker.loading->since) < kLoadTime * std::max(load_seconds_, 0.0);
}

void Affinity::learn_load(ScheduledJob& job, Worker& worker, const ResultArrived& e) {
  if (!worker.loading || worker.loading->frame != FrameId{e.job, e.unit.frame}) return;
  const Worker::Loading loading = *std::exchange(worker.loading, std::nullopt);
  if (!loading.alone || e.render_time <= Duration{0} || options_.scene_time <= Duration{0}) return;
  const double load =
      std::clamp(seconds(step_.now - loading.since - e.render_time), 0.0, kLongestLoad);
  const auto learn = [&](double& known) { known = known < 0 ? load : 0.9 * known + 0.1 * load; };
  learn(job.load_seconds);
  learn(load_seconds_);
}

}  // namespace hyades::coordinator
