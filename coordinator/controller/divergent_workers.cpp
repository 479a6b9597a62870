// Workers that are found odd, and finished frames that they had a part in.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kWorkersKey = 0;  // no job has this number
/// Moments that are remembered of a worker; fewer mean that more frames are doubted.
constexpr size_t kMostMoments = 8;
/// Frames of a job that begin again at once.
constexpr size_t kDoubtedAtOnce = 100;

}  // namespace

/// What workers call themselves; nothing for those who are not known any more. With the lock.
std::vector<std::string> Controller::names_of(const std::vector<WorkerId>& workers) const {
  std::vector<std::string> names;
  for (const WorkerId worker : workers) {
    const auto session = sessions_.find(worker);
    names.push_back(session == sessions_.end() ? std::string() : session->second.hello.worker_id());
  }
  return names;
}

/// The worker rendered a unit of the frame rightly, after the frame was begun: what was finished
/// before that shows nothing wrong of it. (Not after: its film may have come long ago.) With the
/// lock.
void Controller::confirmed(const Confirmed& sure) {
  ActiveJob* active = active_job(sure.job);
  const auto session = sessions_.find(sure.worker);
  if (active == nullptr || session == sessions_.end()) return;
  const uint64_t begun = active->frames[sure.frame].begun;
  if (begun == 0) return;
  const std::string& name = session->second.hello.worker_id();
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
  background_.add(kWorkersKey, [this] { return store_trust(); });
}

bool Controller::store_trust() {
  std::vector<StoredTrust> workers;
  {
    const std::lock_guard lock(mutex_);
    for (const std::string& name : trust_to_store_) {
      if (const auto kept = trust_.find(name); kept != trust_.end()) {
        workers.push_back({name, kept->second.back()});
      }
    }
    trust_to_store_.clear();
    storing_trust_ = false;
  }
  // Where it is lost more is doubted.
  (void)store_->trust(workers);
  return true;
}

/// That a worker is odd is stored with the doubt about all finished frames that it had a part in
/// since it could last be trusted. With the lock.
void Controller::keep_divergent(RecordId record, const WorkerOddRecord& odd) {
  const auto session = sessions_.find(odd.worker);
  ActiveJob* active = active_job(odd.job);
  DivergentWorker kept;
  kept.record = record;
  kept.worker = {session == sessions_.end() ? std::string() : session->second.hello.worker_id(),
                 odd.reason};
  kept.line = {wall_ms(), v1::LOG_LEVEL_WARNING, std::nullopt,
               session == sessions_.end() ? std::string() : session->second.hello.name(),
               "was found odd after it had a part in finished frames, which are in doubt: "};
  // What it rendered wrongly came after this frame was begun.
  const uint64_t begun = active == nullptr ? 0 : active->frames[odd.frame].begun;
  if (const auto trust = trust_.find(kept.worker.worker); trust != trust_.end()) {
    for (const uint64_t moment : trust->second) {
      if (moment <= begun) kept.since = moment;
    }
  }
  if (active != nullptr && kept.worker.worker.empty()) {
    note(
        *active, v1::LOG_LEVEL_WARNING, odd.frame, {},
        "an odd worker has been gone for so long that it is not known which finished frames it had "
        "a part in");
  }
  background_.add(kWorkersKey, [this, kept = std::move(kept)] { return store_divergent(kept); });
}

bool Controller::store_divergent(const DivergentWorker& odd) {
  core::Result<std::vector<JobFrames>> doubted{std::vector<JobFrames>()};
  if (!odd.worker.worker.empty()) doubted = store_->found_odd(odd.worker, odd.since, odd.line);
  if (!doubted) return false;
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    for (JobFrames& job : *doubted) {
      background_.add(job.job, [this, job = std::move(job)] { return doubt_frames(job); });
    }
    later = tell(Persisted{odd.record});
  }
  carry_out(later);
  return true;
}

/// Doubtful frames of an open job begin again, some at a time; for the job's tasks.
bool Controller::doubt_frames(const JobFrames& doubted) {
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    ActiveJob* active = active_job(doubted.job);
    if (active == nullptr || active->ending) return true;
    const size_t now = std::min(kDoubtedAtOnce, doubted.frames.size());
    const auto cut = doubted.frames.begin() + static_cast<ptrdiff_t>(now);
    if (cut != doubted.frames.end()) {
      JobFrames rest{doubted.job, {cut, doubted.frames.end()}};
      background_.add(doubted.job, [this, rest = std::move(rest)] { return doubt_frames(rest); });
    }
    later = tell(FramesDoubted{active->id, {doubted.frames.begin(), cut}});
  }
  carry_out(later);
  return true;
}

}  // namespace hyades::coordinator
