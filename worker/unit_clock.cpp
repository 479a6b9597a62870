#include "worker/unit_clock.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "core/base/duration.h"
#include "core/base/text.h"

namespace hyades::worker {
namespace {

/// Jobs whose pace is remembered.
constexpr size_t kMostSteps = 1000;

}  // namespace

void UnitClock::child_started() {
  child_gone();
  awaited_ = true;
  heard_ = time_;
}

void UnitClock::child_gone() {
  awaited_ = false;
  units_.clear();
}

void UnitClock::heard() {
  awaited_ = false;
  heard_ = time_;
}

void UnitClock::given(uint64_t token, uint64_t job) {
  if (units_.empty()) heard_ = time_;  // an idle child is silent
  units_[token] = {job, Phase::queued, 0, time_};
}

void UnitClock::begun(uint64_t token, bool loading) {
  const auto unit = units_.find(token);
  if (unit == units_.end()) return;
  unit->second.phase = loading ? Phase::loading : Phase::rendering;
  unit->second.moved = time_;
  if (!unit->second.begun) unit->second.begun = time_;
}

void UnitClock::progress(uint64_t token, uint64_t samples) {
  const auto found = units_.find(token);
  if (found == units_.end() || found->second.samples == samples) return;
  Unit& unit = found->second;
  if (steps_.size() >= kMostSteps && !steps_.contains(unit.job)) steps_.erase(steps_.begin());
  Duration& longest = steps_[unit.job];
  longest = std::max(longest, time_ - unit.moved);
  unit.samples = samples;
  unit.moved = time_;
}

void UnitClock::tick(TimePoint now) {
  constexpr Duration kLongestTick = std::chrono::seconds(1);
  if (ticked_) time_ += std::clamp<Duration>(now - *ticked_, Duration(0), kLongestTick);
  ticked_ = now;
}

UnitClock::Overdue UnitClock::overdue() {
  Overdue overdue;
  if (unit_limit_ <= Duration(0)) return overdue;
  for (auto& [token, unit] : units_) {
    if (unit.overdue_since) {
      overdue.stuck = overdue.stuck || time_ - *unit.overdue_since >= kStopping;
    } else if (unit.begun && time_ - *unit.begun >= unit_limit_) {
      overdue.tokens.push_back(token);
      overdue.stuck = overdue.stuck || unit.phase == Phase::loading;
      unit.overdue_since = time_;
    }
  }
  return overdue;
}

std::string UnitClock::overdue_reason() const {
  return fmt::format("took longer than {} (--unit-time-limit of the worker)",
                     core::format_duration(core::seconds(unit_limit_)));
}

UnitClock::Duration UnitClock::patience_with(const Unit& unit) const {
  if (unit.phase == Phase::loading) return kLoading * hang_limit_;
  const auto step = steps_.find(unit.job);
  return step == steps_.end() ? hang_limit_ : std::max(hang_limit_, kSlack * step->second);
}

std::optional<UnitClock::Hang> UnitClock::hang() {
  if (hang_limit_ <= Duration(0)) return std::nullopt;
  Hang hang;
  bool only_loads = true;
  bool busy = units_.empty();
  Duration longest{0};
  for (const auto& [token, unit] : units_) {
    const Duration still = time_ - unit.moved;
    busy = busy || unit.phase != Phase::queued;
    if (unit.phase == Phase::queued || still < patience_with(unit)) continue;
    hang.tokens.insert(token);
    longest = std::max(longest, still);
    only_loads = only_loads && unit.phase == Phase::loading;
  }
  if (busy) busy_ = time_;
  if (!hang.tokens.empty()) {
    hang.reason = fmt::format("{} {:.3g} s and was killed",
                              only_loads ? "was loading a scene for" : "had no sample done in",
                              core::seconds(longest));
  } else if ((awaited_ || !units_.empty()) && time_ - heard_ >= hang_limit_) {
    for (const auto& [token, unit] : units_) {
      if (unit.phase != Phase::queued) hang.tokens.insert(token);
    }
    hang.reason = fmt::format("gave no sign of life for {:.3g} s and was killed",
                              core::seconds(time_ - heard_));
  } else if (time_ - busy_ >= kLoading * hang_limit_) {
    hang.reason =
        fmt::format("began nothing in {:.3g} s and was killed", core::seconds(time_ - busy_));
  } else {
    return std::nullopt;
  }
  child_gone();
  return hang;
}

}  // namespace hyades::worker
