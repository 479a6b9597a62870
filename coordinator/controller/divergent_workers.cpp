#include "coordinator/controller/divergent_workers.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/wall_clock.h"

namespace hyades::coordinator {
namespace {

/// Moments that are remembered of a worker; fewer mean that more frames are doubted.
constexpr size_t kMostMoments = 8;
/// Frames of a job that begin again at once.
constexpr size_t kDoubtedAtOnce = 100;

}  // namespace

core::Status DivergentWorkers::load() {
  const auto trusted = shared_.store->trusted();
  if (!trusted) return trusted.error();
  const StateLock lock(shared_.mutex);
  for (const StoredTrust& kept : *trusted) trust_[kept.worker] = {kept.moment};
  return {};
}

/// The worker rendered a unit of the frame rightly, after the frame was begun: what was finished
/// before that shows nothing wrong of it. (Not after: its film may have come long ago.)
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
  shared_.background.add(Shared::kWorkersKey, [this] { return store_trust(); });
}

bool DivergentWorkers::store_trust() {
  std::vector<StoredTrust> workers;
  {
    const StateLock lock(shared_.mutex);
    for (const std::string& name : trust_to_store_) {
      if (const auto kept = trust_.find(name); kept != trust_.end()) {
        workers.push_back({name, kept->second.back()});
      }
    }
    trust_to_store_.clear();
    storing_trust_ = false;
  }
  // Where it is lost more is doubted.
  (void)shared_.store->trust(workers);
  return true;
}

/// That a worker is odd is stored with the doubt about all finished frames that it had a part in
/// since it could last be trusted.
void DivergentWorkers::keep(RecordId record, const DivergentWorkerRecord& odd) {
  const WorkerSession* session = workers_.find(odd.worker);
  ActiveJob* active = jobs_.find(odd.job);
  Found kept;
  kept.record = record;
  kept.worker = {session == nullptr ? std::string() : session->hello.worker_id(), odd.reason};
  kept.line = {wall_ms(), v1::LOG_LEVEL_WARNING, std::nullopt,
               session == nullptr ? std::string() : session->hello.name(),
               "was found odd after it had a part in finished frames, which are in doubt: "};
  // What it rendered wrongly came after this frame was begun.
  const uint64_t begun = active == nullptr ? 0 : active->frames[odd.frame].begun;
  if (const auto trust = trust_.find(kept.worker.worker); trust != trust_.end()) {
    for (const uint64_t moment : trust->second) {
      if (moment <= begun) kept.since = moment;
    }
  }
  if (active != nullptr && kept.worker.worker.empty()) {
    jobs_.note(
        *active, v1::LOG_LEVEL_WARNING, odd.frame, {},
        "an odd worker has been gone for so long that it is not known which finished frames it had "
        "a part in");
  }
  shared_.background.add(Shared::kWorkersKey,
                         [this, kept = std::move(kept)] { return store(kept); });
}

bool DivergentWorkers::store(const Found& odd) {
  core::Result<std::vector<JobFrames>> doubted{std::vector<JobFrames>()};
  if (!odd.worker.worker.empty())
    doubted = shared_.store->found_odd(odd.worker, odd.since, odd.line);
  if (!doubted) return false;
  Turn turn(dispatcher_);
  for (JobFrames& job : *doubted) {
    shared_.background.add(job.job, [this, job = std::move(job)] { return doubt_frames(job); });
  }
  turn.tell(Persisted{odd.record});
  return true;
}

/// Doubtful frames of an open job begin again, some at a time; for the job's tasks.
bool DivergentWorkers::doubt_frames(const JobFrames& doubted) {
  Turn turn(dispatcher_);
  ActiveJob* active = jobs_.find(doubted.job);
  if (active == nullptr || active->ending) return true;
  const size_t now = std::min(kDoubtedAtOnce, doubted.frames.size());
  const auto cut = doubted.frames.begin() + static_cast<ptrdiff_t>(now);
  if (cut != doubted.frames.end()) {
    JobFrames rest{doubted.job, {cut, doubted.frames.end()}};
    shared_.background.add(doubted.job,
                           [this, rest = std::move(rest)] { return doubt_frames(rest); });
  }
  turn.tell(FramesSuspected{active->id, {doubted.frames.begin(), cut}});
  return true;
}

}  // namespace hyades::coordinator
