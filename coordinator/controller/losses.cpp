// Units that go to others, in the jobs' logs: a line per worker and job, however many they are.
#include <map>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/controller/counted.h"
#include "farm/log.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostFramesNamed = 5;

/// "3 units of frame 7 go", "9 units of frames 7, 8 go", "400 units of 80 frames go".
std::string in_words(const std::map<int32_t, uint32_t>& units_of) {
  uint32_t units = 0;
  std::vector<int32_t> frames;
  for (const auto& [frame, count] : units_of) {
    units += count;
    frames.push_back(frame);
  }
  const std::string of =
      frames.size() > kMostFramesNamed
          ? counted(frames.size(), "frame")
          : fmt::format("{} {}", frames.size() == 1 ? "frame" : "frames", fmt::join(frames, ", "));
  return fmt::format("{} of {} {}", counted(units, "unit"), of, units == 1 ? "goes" : "go");
}

}  // namespace

/// That the worker has the units no more, and why; with the lock.
void Controller::note_losses(const WorkerSession& session, const std::vector<UnitInHand>& units,
                             const std::string& why) {
  std::map<JobId, std::map<int32_t, uint32_t>> lost;
  for (const UnitInHand& held : units) ++lost[held.job][held.unit.frame];
  for (const auto& [job, frames] : lost) {
    ActiveJob* active = active_job(job);
    if (active == nullptr) continue;
    std::optional<int32_t> frame;
    if (frames.size() == 1) frame = frames.begin()->first;
    note(*active, v1::LOG_LEVEL_WARNING, frame, session.hello.name(),
         why + ": " + in_words(frames) + " to others");
  }
}

/// Leases that ran out; with the lock.
void Controller::note_expired(const std::vector<Action>& actions) {
  std::map<WorkerId, std::vector<UnitInHand>> lost;
  for (const Action& action : actions) {
    const auto* revoke = std::get_if<Revoke>(&action);
    if (revoke == nullptr || !revoke->expired) continue;
    lost[revoke->worker].push_back({revoke->lease, revoke->job, revoke->unit});
  }
  for (const auto& [worker, units] : lost) {
    const auto session = sessions_.find(worker);
    if (session == sessions_.end()) continue;
    note_losses(session->second, units, "did not renew its leases in time");
  }
}

/// In the logs of the jobs that it has worked for since it came; with the lock.
void Controller::note_quarantine(const WorkerSession& session) {
  farm::log_later(
      farm::LogLevel::warning,
      session.reason.empty() ? "is in quarantine" : "is in quarantine: " + session.reason,
      {{}, {}, {}, session.hello.name()});
  for (const JobId job : session.spec_sent) {
    if (ActiveJob* active = active_job(job)) {
      note(*active, v1::LOG_LEVEL_WARNING, std::nullopt, session.hello.name(),
           session.reason.empty() ? "is in quarantine" : "is in quarantine: " + session.reason);
    }
  }
}

/// Nobody will come under this number any more; with the lock.
std::vector<Action> Controller::forget(WorkerId worker) {
  const auto session = sessions_.find(worker);
  worker_ids_.erase(session->second.hello.worker_id());
  sessions_.erase(session);
  return tell(WorkerForgotten{worker});
}

}  // namespace hyades::coordinator
