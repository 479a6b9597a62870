#include "coordinator/controller/divergent_workers.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/base/wall_clock.h"

namespace hyades::coordinator {
namespace {

/// Moments that are remembered of a worker; fewer mean that more frames are suspect.
constexpr size_t kMostMoments = 8;
/// Frames of a job that begin again at once.
constexpr size_t kSuspectedAtOnce = 100;

}  // namespace

core::Status DivergentWorkers::load() {
  const auto trusted = context_.store->trusted();
  if (!trusted) return trusted.error();
  const StateLock lock(context_.mutex);
  for (const StoredTrust& kept : *trusted) trust_[kept.worker] = {kept.moment};
  return {};
}

void DivergentWorkers::confirmed(const Confirmed& sure) {
  ActiveJob* active = jobs_.find(sure.job);
  const WorkerSession* session = workers_.find(sure.worker);
  if (active == nullptr || session == nullptr) return;
  const uint64_t begun = active->frames[sure.frame].begun;
  if (begun == 0) return;
  const std::string& name = session->hello.worker_id();
  std::vector<uint64_t>& moments = trust_[name];
  if (!moments.empty() && moments.back() >= begun) return;
  if (moments.size() == kMostMoments) moments.erase(moments.begin() + 1);
  moments.push_back(begun);
  if (trust_.size() > kMostTrusted) {
    trust_.erase(std::min_element(trust_.begin(), trust_.end(), [](const auto& a, const auto& b) {
      return a.second.back() < b.second.back();
    }));
  }
  trust_to_store_.insert(name);
  if (std::exchange(storing_trust_, true)) return;
  context_.background.add(ControllerContext::kWorkersKey, [this] { return store_trust(); });
}

bool DivergentWorkers::store_trust() {
  std::vector<StoredTrust> workers;
  {
    const StateLock lock(context_.mutex);
    for (const std::string& name : trust_to_store_) {
      if (const auto kept = trust_.find(name); kept != trust_.end()) {
        workers.push_back({name, kept->second.back()});
      }
    }
    trust_to_store_.clear();
    storing_trust_ = false;
  }
  // Where it is lost more is suspect.
  (void)context_.store->trust(workers);
  return true;
}

void DivergentWorkers::keep(RecordId record, const DivergentWorkerRecord& divergent) {
  const WorkerSession* session = workers_.find(divergent.worker);
  ActiveJob* active = jobs_.find(divergent.job);
  Found kept;
  kept.record = record;
  kept.worker = {session == nullptr ? std::string() : session->hello.worker_id(), divergent.reason};
  kept.line = {core::wall_ms(), v1::LOG_LEVEL_WARNING, std::nullopt,
               session == nullptr ? std::string() : session->hello.name(),
               "was found divergent after it had a part in finished frames, which are in doubt: "};
  // What it rendered wrongly came after this frame was begun.
  const uint64_t begun = active == nullptr ? 0 : active->frames[divergent.frame].begun;
  if (const auto trust = trust_.find(kept.worker.worker); trust != trust_.end()) {
    for (const uint64_t moment : trust->second) {
      if (moment <= begun) kept.since = moment;
    }
  }
  if (active != nullptr && kept.worker.worker.empty()) {
    jobs_.note(*active, v1::LOG_LEVEL_WARNING, divergent.frame, {},
               "a divergent worker has been gone for so long that it is not known which finished "
               "frames it had "
               "a part in");
  }
  context_.background.add(ControllerContext::kWorkersKey,
                          [this, kept = std::move(kept)] { return store(kept); });
}

bool DivergentWorkers::store(const Found& found) {
  core::Result<std::vector<SuspectFrames>> suspected{std::vector<SuspectFrames>()};
  if (!found.worker.worker.empty())
    suspected = context_.store->mark_divergent(found.worker, found.since, found.line);
  if (!suspected) return false;
  Turn turn(dispatcher_);
  for (SuspectFrames& job : *suspected) {
    const uint64_t id = job.job;
    const ActiveJob* active = jobs_.find(id);
    if (active == nullptr) continue;
    context_.in_background(*active, [this, job = std::move(job)] { return suspect_frames(job); });
  }
  turn.tell(Persisted{found.record});
  return true;
}

/// Suspect frames of an open job begin again, some at a time; for the job's tasks.
bool DivergentWorkers::suspect_frames(const SuspectFrames& suspected) {
  Turn turn(dispatcher_);
  ActiveJob* active = jobs_.find(suspected.job);
  if (active == nullptr || active->ending) return true;
  const size_t now = std::min(kSuspectedAtOnce, suspected.frames.size());
  const auto cut = suspected.frames.begin() + static_cast<ptrdiff_t>(now);
  if (cut != suspected.frames.end()) {
    SuspectFrames rest{suspected.job, {cut, suspected.frames.end()}};
    context_.in_background(*active,
                           [this, rest = std::move(rest)] { return suspect_frames(rest); });
  }
  turn.tell(FramesSuspected{active->id, {suspected.frames.begin(), cut}});
  return true;
}

}  // namespace hyades::coordinator
