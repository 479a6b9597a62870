// Units that go to others, in the jobs' logs: a line per worker and job, however many they are.
#include <map>
#include <utility>

#include <fmt/format.h>

#include "coordinator/brain/brain.h"
#include "coordinator/brain/counted.h"
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
void Brain::note_losses(const Seat& seat, const std::vector<UnitInHand>& units,
                        const std::string& why) {
  std::map<JobId, std::map<int32_t, uint32_t>> lost;
  for (const UnitInHand& held : units) ++lost[held.job][held.unit.frame];
  for (const auto& [job, frames] : lost) {
    JobDesk* desk = desk_of(job);
    if (desk == nullptr) continue;
    std::optional<int32_t> frame;
    if (frames.size() == 1) frame = frames.begin()->first;
    note(*desk, v1::LOG_LEVEL_WARNING, frame, seat.hello.name(),
         why + ": " + in_words(frames) + " to others");
  }
}

/// Leases that ran out; with the lock.
void Brain::note_expired(const std::vector<Action>& actions) {
  std::map<WorkerId, std::vector<UnitInHand>> lost;
  for (const Action& action : actions) {
    const auto* revoke = std::get_if<Revoke>(&action);
    if (revoke == nullptr || !revoke->expired) continue;
    lost[revoke->worker].push_back({revoke->lease, revoke->job, revoke->unit});
  }
  for (const auto& [worker, units] : lost) {
    const auto seat = seats_.find(worker);
    if (seat == seats_.end()) continue;
    note_losses(seat->second, units, "did not renew its leases in time");
  }
}

/// In the logs of the jobs that it has worked for since it came; with the lock.
void Brain::note_quarantine(const Seat& seat) {
  farm::log_later(farm::LogLevel::warning,
                  seat.reason.empty() ? "is in quarantine" : "is in quarantine: " + seat.reason,
                  {{}, {}, {}, seat.hello.name()});
  for (const JobId job : seat.briefed) {
    if (JobDesk* desk = desk_of(job)) {
      note(*desk, v1::LOG_LEVEL_WARNING, std::nullopt, seat.hello.name(),
           seat.reason.empty() ? "is in quarantine" : "is in quarantine: " + seat.reason);
    }
  }
}

/// Nobody will come under this number any more; with the lock.
std::vector<Action> Brain::forget(WorkerId worker) {
  const auto seat = seats_.find(worker);
  worker_ids_.erase(seat->second.hello.worker_id());
  seats_.erase(seat);
  return tell(WorkerForgotten{worker});
}

}  // namespace hyades::coordinator
