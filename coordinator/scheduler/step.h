#pragma once

#include <utility>
#include <vector>

#include "coordinator/scheduler/actions.h"
#include "coordinator/scheduler/ids.h"

namespace hyades::coordinator {

/// One call of Scheduler::handle(), which the scheduler's parts share: when it is, and what they
/// say.
struct Step {
  TimePoint now;
  std::vector<Action> actions;
  /// Something may have turned up for workers that wait, since they were last served.
  bool work_appeared = false;

  void say(Action action) { actions.push_back(std::move(action)); }
};

}  // namespace hyades::coordinator
