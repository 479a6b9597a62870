#include "worker/departure.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.h"

namespace hyades::worker {
namespace {

using farm::LogLevel;

/// How long the end of the stream may take when all is said.
constexpr std::chrono::milliseconds kGoodbye{200};
/// What is left of a cloud's notice, in seconds, when the worker is gone.
constexpr double kLastSeconds = 3;
/// However long a cloud's notice is, in seconds.
constexpr double kLongestLeave = 120;

}  // namespace

Departure::Departure(const WorkerContext& worker, RendererSupervisor& renderer,
                     CoordinatorSession& session, TimePoint start)
    : worker_(worker), renderer_(renderer), session_(session), idle_since_(start) {}

void Departure::watch_for_preemption() {
  const WorkerOptions& options = worker_.options;
  if (!options.cloud) return;
  worker_.log.note(LogLevel::info, fmt::format("watches for notices of pre-emption by {}",
                                               name_of(*options.cloud)));
  preemption_.emplace(*options.cloud, options.cloud_endpoint,
                      static_cast<PreemptionWatch::Listener&>(*this));
}

void Departure::preempted(const Notice& notice) {
  worker_.loop.post([this, notice] {
    const double time = std::max(notice.seconds_left - kLastSeconds, worker_.options.grace);
    leave(std::chrono::steady_clock::now(),
          fmt::format("pre-empted by {} at {}", name_of(*worker_.options.cloud), notice.at),
          in_seconds(std::min(time, kLongestLeave)));
  });
}

void Departure::watch_trouble(const std::string& reason) {
  worker_.loop.post([this, reason] {
    worker_.log.note(LogLevel::warning,
                     fmt::format("no notice of pre-emption by {} can be had ({}); trying again",
                                 name_of(*worker_.options.cloud), reason));
  });
}

/// Hands over what is done and gives the rest back, within `time`; asked again, it is hastened.
void Departure::leave(TimePoint now, const std::string& reason, Duration time) {
  const TimePoint by = now + std::max(time - kGoodbye, Duration(0));
  if (!leave_by_) {
    worker_.log.note(LogLevel::info, reason + ": batches that are done are handed over");
    reason_ = reason;
    status_ = worker_.options.told_status;
    renderer_.last();
    worker_.machine.leave(reason, true);
  }
  leave_by_ = leave_by_ ? std::min(*leave_by_, by) : by;
}

void Departure::asked(TimePoint now) {
  if (std::exchange(asked_, true)) return;
  leave(now, "asked to leave", in_seconds(worker_.options.grace));
}

/// Films that nobody takes are no work: a coordinator that has been away for so long may never
/// come back, and others render them again.
bool Departure::busy() const {
  if (!renderer_.ready()) return true;
  const StateMachine& machine = worker_.machine;
  return !machine.empty() && (machine.attended() || machine.in_hand() > machine.unacknowledged());
}

void Departure::leave_if_idle(TimePoint now) {
  if (busy()) idle_since_ = now;
  const Duration limit = in_seconds(worker_.options.idle_limit);
  const bool idle = limit > Duration(0) && now - idle_since_ >= limit;
  if (!idle || worker_.machine.leaving()) return;
  worker_.log.note(LogLevel::info, fmt::format("no work for {}: leaving",
                                               core::format_duration(worker_.options.idle_limit)));
  leave_by_ = now;
  reason_ = "without work";
  renderer_.last();
  worker_.machine.leave(reason_, false);
}

void Departure::try_to_go(TimePoint now) {
  if (!worker_.machine.leaving()) return;
  const bool late = leave_by_ && now >= *leave_by_;
  if (!goodbye_by_ && (worker_.machine.empty() || late)) {
    worker_.machine.give_back_rest(reason_);
    if (const size_t films = worker_.machine.unacknowledged(); films > 0) {
      worker_.log.note(LogLevel::warning, core::counted(films, "film") +
                                              (films == 1 ? " was" : " were") +
                                              " not acknowledged in time");
    }
    session_.finish();
    goodbye_by_ = now + kGoodbye;
  }
  if (goodbye_by_ && (now >= *goodbye_by_ || !session_.open())) worker_.loop.end(status_);
}

}  // namespace hyades::worker
