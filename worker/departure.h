#pragma once

#include <optional>
#include <string>

#include "worker/clouds/preemption_watch.h"
#include "worker/coordinator_session.h"
#include "worker/renderer_supervisor.h"
#include "worker/worker_context.h"

namespace hyades::worker {

/// When and how a worker goes: because somebody asks it to, because a cloud takes its machine away,
/// because it has nothing to do, because it was drained. For the loop's thread.
class Departure : private PreemptionWatch::Listener {
 public:
  /// Time without work counts from `start` on.
  Departure(const WorkerContext& worker, RendererSupervisor& renderer, CoordinatorSession& session,
            TimePoint start);

  /// Begins to watch for notices of the cloud, where the options name one.
  void watch_for_preemption();
  /// A signal has come: goes within the options' grace.
  void asked(TimePoint now);
  /// Leaves when there was no work for long enough.
  void leave_if_idle(TimePoint now);
  /// Ends the loop when a worker that leaves has nothing in hand any more, or its time is up.
  void try_to_go(TimePoint now);

 private:
  void preempted(const Notice& notice) override;
  void watch_trouble(const std::string& reason) override;
  void leave(TimePoint now, const std::string& reason, Duration time);
  bool busy() const;

  const WorkerContext worker_;
  RendererSupervisor& renderer_;
  CoordinatorSession& session_;
  TimePoint idle_since_;  ///< when there was work last
  bool asked_ = false;
  std::optional<TimePoint> leave_by_;
  std::string reason_ = "drained";
  int status_ = 0;
  std::optional<TimePoint> goodbye_by_;
  std::optional<PreemptionWatch> preemption_;  ///< last: its thread posts
};

}  // namespace hyades::worker
