#include "worker/render_watch.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/duration.h"

namespace hyades::worker {
namespace {

/// Jobs whose pace is remembered.
constexpr size_t kMostSteps = 1000;

}  // namespace

void RenderWatch::child_started() {
  child_gone();
  awaited_ = true;
  heard_ = clock_.passed();
}

void RenderWatch::child_gone() {
  awaited_ = false;
  tasks_.clear();
}

void RenderWatch::heard() {
  awaited_ = false;
  heard_ = clock_.passed();
}

void RenderWatch::told(uint64_t token, uint64_t job) {
  if (tasks_.empty()) heard_ = clock_.passed();  // an idle child is silent
  tasks_[token] = {job, Phase::queued, 0, clock_.passed()};
}

void RenderWatch::loading(uint64_t token) { begin(token, Phase::loading); }
void RenderWatch::rendering(uint64_t token) { begin(token, Phase::rendering); }

void RenderWatch::begin(uint64_t token, Phase phase) {
  const auto task = tasks_.find(token);
  if (task == tasks_.end()) return;
  task->second.phase = phase;
  task->second.moved = clock_.passed();
}

void RenderWatch::progress(uint64_t token, uint64_t samples) {
  const auto found = tasks_.find(token);
  if (found == tasks_.end() || found->second.samples == samples) return;
  Task& task = found->second;
  if (steps_.size() >= kMostSteps && !steps_.contains(task.job)) steps_.erase(steps_.begin());
  Duration& longest = steps_[task.job];
  longest = std::max(longest, clock_.passed() - task.moved);
  task.samples = samples;
  task.moved = clock_.passed();
}

void RenderWatch::answered(uint64_t token) { tasks_.erase(token); }

RenderWatch::Duration RenderWatch::patience_with(const Task& task) const {
  if (task.phase == Phase::loading) return kLoading * limit_;
  const auto step = steps_.find(task.job);
  return step == steps_.end() ? limit_ : std::max(limit_, kSlack * step->second);
}

std::optional<RenderWatch::Hang> RenderWatch::tick(TimePoint now) {
  const Duration time = clock_.tick(now);
  if (limit_ <= Duration(0)) return std::nullopt;
  Hang hang;
  bool only_loads = true;
  bool busy = tasks_.empty();
  Duration longest{0};
  for (const auto& [token, task] : tasks_) {
    const Duration still = time - task.moved;
    busy = busy || task.phase != Phase::queued;
    if (task.phase == Phase::queued || still < patience_with(task)) continue;
    hang.tokens.insert(token);
    longest = std::max(longest, still);
    only_loads = only_loads && task.phase == Phase::loading;
  }
  if (busy) busy_ = time;
  if (!hang.tokens.empty()) {
    hang.reason = fmt::format("{} {:.3g} s and was killed",
                              only_loads ? "was loading a scene for" : "had no sample done in",
                              core::seconds(longest));
  } else if ((awaited_ || !tasks_.empty()) && time - heard_ >= limit_) {
    for (const auto& [token, task] : tasks_) {
      if (task.phase != Phase::queued) hang.tokens.insert(token);
    }
    hang.reason = fmt::format("gave no sign of life for {:.3g} s and was killed",
                              core::seconds(time - heard_));
  } else if (time - busy_ >= kLoading * limit_) {
    hang.reason =
        fmt::format("began nothing in {:.3g} s and was killed", core::seconds(time - busy_));
  } else {
    return std::nullopt;
  }
  child_gone();
  return hang;
}

}  // namespace hyades::worker
