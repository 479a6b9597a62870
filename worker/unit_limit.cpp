#include "worker/unit_limit.h"

#include <fmt/format.h>

#include "core/base/duration.h"
#include "core/base/text.h"

namespace hyades::worker {

void UnitLimit::begun(uint64_t token, bool loading) {
  Task& task = tasks_.try_emplace(token, Task{time_.passed()}).first->second;
  task.loading = loading;
}

UnitLimit::Overdue UnitLimit::tick(TimePoint now) {
  const Duration time = time_.tick(now);
  Overdue overdue;
  if (limit_ <= Duration(0)) return overdue;
  for (auto& [token, task] : tasks_) {
    if (task.told) {
      overdue.stuck = overdue.stuck || time - *task.told >= kStopping;
    } else if (time - task.begun >= limit_) {
      overdue.tokens.push_back(token);
      overdue.stuck = overdue.stuck || task.loading;
      task.told = time;
    }
  }
  return overdue;
}

std::string UnitLimit::reason() const {
  return fmt::format("took longer than {} (--unit-time-limit of the worker)",
                     core::format_duration(core::seconds(limit_)));
}

}  // namespace hyades::worker
