// Deaths, cuts, and people at the controls.
#include "tests/coordinator/scheduler/simulated_world.h"

namespace hyades::coordinator {

/// Deaths, cuts, and people at the controls.
void SimulatedWorld::nature() {
  if (now_ >= faults_end_) {
    for (auto& [id, job] : jobs_) {
      if (std::exchange(job.paused, false)) tell(JobResumed{id});
    }
    if (!scheduler_) return after(std::chrono::seconds(1), [this] { nature(); });
    for (size_t i = 0; i < workers_.size(); ++i) connect(i);
    return;
  }
  const auto i = static_cast<size_t>(number(0, static_cast<int>(workers_.size()) - 1));
  SimWorker& w = workers_[i];
  const auto job = std::next(jobs_.begin(), number(0, static_cast<int>(jobs_.size()) - 1));
  if (chance(2 * fault_rate_) && w.connected) {
    w.connected = false;
    ++w.session;
    if (chance(0.5)) {
      ++kills;
      ++w.life;
      w.held.clear();
      // It comes back with another build.
      if (options_.class_patience > Duration{0} && !corrupt_ && chance(0.3)) w.name += "'";
    }
    // The coordinator notices now, later, or not before it is back.
    const uint64_t session = w.session;
    after(delay(), [this, i, session] {
      if (workers_[i].session == session) tell(WorkerLost{id_of(i)});
    });
    after(std::chrono::milliseconds(number(10, 8000)), [this, i] { connect(i); });
  }
  if (chance(fault_rate_ / 4) && scheduler_) crash_coordinator(real_store_ && chance(0.5));
  if (real_store_ && chance(fault_rate_ / 4) && scheduler_) disks_fill();
  if (chance(fault_rate_ / 4)) now_ += std::chrono::seconds(number(1, 100));
  if ((chance(fault_rate_ / 2) || (cramped_ && chance(job->second.paused ? 0.15 : 0.5))) &&
      !job->second.ended) {
    job->second.paused = !job->second.paused;
    if (job->second.paused) {
      tell(JobPaused{job->first});
    } else {
      tell(JobResumed{job->first});
    }
  }
  if (chance(fault_rate_ / 4) && !job->second.ended) {
    tell(JobReprioritised{job->first, job->second.plan.priority = number(0, 2)});
  }
  if (chance(fault_rate_ / 8) && !job->second.ended) tell(FramesRetried{job->first});
  if (chance(fault_rate_ / 2)) {
    tell(WorkerBarred{id_of(i), true});
    after(std::chrono::milliseconds(number(10, 20000)), [this, i] {
      if (workers_[i].quarantined_by == 0) tell(WorkerBarred{id_of(i), false});
    });
  }
  if (chance(fault_rate_ / 20) && !job->second.ended && scheduler_) {
    job->second.cancelled = true;
    tell(JobCancelled{job->first});
  }
  after(std::chrono::milliseconds(number(10, 1000)), [this] { nature(); });
}

}  // namespace hyades::coordinator
