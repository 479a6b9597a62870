#include "cli/client/scale_decision.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/text.h"

namespace hyades::cli {
namespace {

/// Seconds of work that a new worker is worth its start for.
constexpr double kWorthAStart = 60;
/// What a deadline that is near, or past, is taken for, s.
constexpr double kSoonest = 60;

uint32_t whole(double workers) {
  return static_cast<uint32_t>(std::clamp(std::ceil(workers - 1e-9), 0.0, 1e9));
}

/// The most workers that all jobs together can use.
double usable(const std::vector<ScaleJob>& jobs) {
  double sum = 0;
  for (const ScaleJob& job : jobs) sum += job.max_workers > 0 ? job.max_workers : 1e9;
  return sum;
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
  double so_far = 0;
  for (const ScaleJob& job : due) {
    so_far += *job.core_seconds;
    needed = std::max(needed, so_far / threads / std::max(job.seconds_left, kSoonest));
  }
  const double worth = std::ceil(work / threads / kWorthAStart);
  const double wished = std::min({needed, std::max(worth, 1.0), usable(state.jobs)});
  uint32_t wanted = std::max(whole(wished), 1U);
  std::string why = fmt::format("{} of work", core::format_duration(work / threads));
  if (unmeasured) why += due.empty() ? " that nobody has begun" : " and more";
  if (due.empty() && unmeasured) why = "work that nobody has begun";
  if (wanted > most) why += fmt::format("; {} workers would be right", wanted);
  wanted = std::clamp(wanted, state.least, most);
  if (state.price && *state.price > 0) {
    const double hours = std::max(state.interval, 1.0) / 3600;
    const auto paid = static_cast<uint32_t>(std::clamp(
        std::floor(std::max(state.money_left, 0.0) / (*state.price * hours) + 1e-9), 0.0, 1e9));
    if (paid < wanted) {
      wanted = std::max(paid, state.least);
      why += fmt::format("; {:.2f} are left to be spent", std::max(state.money_left, 0.0));
    }
  }
  return {wanted, why};
}

uint32_t ScaleDamper::follow(uint32_t wanted, TimePoint now) {
  lately_.emplace_back(now, wanted);
  std::erase_if(lately_, [&](const auto& one) { return now - one.first > delay_; });
  return std::max_element(lately_.begin(), lately_.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->second;
}

}  // namespace hyades::cli
