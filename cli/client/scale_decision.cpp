#include "cli/client/scale_decision.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <fmt/format.h>

#include "core/base/text.h"

namespace hyades::cli {
namespace {

/// What a deadline that is near, or past, is taken for, s: so no worker starts for less work than
/// that.
constexpr double kSoonest = 60;

uint32_t whole(double workers) {
  return static_cast<uint32_t>(std::clamp(std::ceil(workers - 1e-9), 0.0, 1e9));
}

/// How many of `due`, which are due within `seconds`, can be at work on them so that they are done
/// in time.
double workers_within(double seconds, std::span<const ScaleJob> due, double threads) {
  double sum = 0;
  for (const ScaleJob& job : due) {
    const double needed = *job.core_seconds / threads / seconds;
    sum += job.max_workers > 0 ? std::min<double>(needed, job.max_workers) : needed;
  }
  return sum;
}

/// How many workers the money that is left pays until the next decision.
uint32_t affordable(const ScaleState& state) {
  const double hours = std::max(state.interval, 1.0) / 3600;
  const double paid = std::floor(std::max(state.money_left, 0.0) / (*state.price * hours) + 1e-9);
  return static_cast<uint32_t>(std::min(paid, 1e9));
}

}  // namespace

ScaleDecision decide_scale(const ScaleState& state) {
  const uint32_t most = std::max(state.most, state.least);
  if (state.jobs.empty()) return {state.least, "no work"};
  std::vector<ScaleJob> due;
  bool unmeasured = false;
  double work = 0;
  for (const ScaleJob& job : state.jobs) {
    if (!job.core_seconds) unmeasured = true;
    if (!job.core_seconds || *job.core_seconds <= 0) continue;
    work += *job.core_seconds;
    due.push_back(job);
  }
  std::sort(due.begin(), due.end(),
            [](const ScaleJob& a, const ScaleJob& b) { return a.seconds_left < b.seconds_left; });
  const double threads = std::max(state.threads_per_worker, 1.0);
  double needed = 0;
  // O(jobs) where all are due together, which --finish-by means; else O(jobs^2), of a queue's
  // thousand.
  for (size_t i = 0; i < due.size(); ++i) {
    const double seconds = std::max(due[i].seconds_left, kSoonest);
    if (i + 1 < due.size() && std::max(due[i + 1].seconds_left, kSoonest) == seconds) continue;
    needed = std::max(needed, workers_within(seconds, std::span(due).first(i + 1), threads));
  }
  uint32_t wanted = std::max(whole(needed), 1U);
  std::string why = fmt::format("{} of work", core::format_duration(work / threads));
  if (unmeasured) why += due.empty() ? " that nobody has begun" : " and more";
  if (due.empty() && unmeasured) why = "work that nobody has begun";
  if (wanted > most) why += fmt::format("; {} workers would be right", wanted);
  wanted = std::clamp(wanted, state.least, most);
  return {wanted, why};
}

uint32_t ScaleDamper::follow(uint32_t wanted, TimePoint now) {
  lately_.emplace_back(now, wanted);
  std::erase_if(lately_, [&](const auto& one) { return now - one.first > delay_; });
  return std::max_element(lately_.begin(), lately_.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->second;
}

ScaleDecision ScalePlan::next(const ScaleState& state, ScaleDamper::TimePoint now) {
  ScaleDecision decision = decide_scale(state);
  const uint32_t enough = decision.wanted;
  decision.wanted = damper_.follow(enough, now);
  if (decision.wanted > enough) {
    decision.why += fmt::format("; {} are enough, waits before it sends others home", enough);
  }
  if (!state.price || *state.price <= 0) return decision;
  if (const uint32_t paid = affordable(state); paid < decision.wanted) {
    decision.wanted = std::max(paid, state.least);
    decision.why += fmt::format("; {:.2f} are left to be spent", std::max(state.money_left, 0.0));
  }
  return decision;
}

}  // namespace hyades::cli
