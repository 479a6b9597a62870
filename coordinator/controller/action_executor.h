#pragma once

#include <vector>

#include "coordinator/controller/worker_table.h"

namespace hyades::coordinator {

class DivergentWorkers;
class FrameProgress;
class JobFilms;
class JobRecords;
class VideoMaker;
class WorkerSessions;

/// Has each action of the scheduler carried out by the part that it concerns.
class ActionExecutor final : public Dispatcher::ActionHandler {
 public:
  ActionExecutor(ControllerContext& context, JobTable& jobs, WorkerTable& workers,
                 WorkerSessions& sessions, JobFilms& films, FrameProgress& frames,
                 DivergentWorkers& divergent, JobRecords& records, VideoMaker& videos)
      : context_(context),
        jobs_(jobs),
        workers_(workers),
        sessions_(sessions),
        films_(films),
        frames_(frames),
        divergent_(divergent),
        records_(records),
        videos_(videos) {}

  void act(const std::vector<Action>& actions, Turn& turn, Delivery* delivery) override
      HYADES_REQUIRES(state_lock);
  void carry_out(const DeferredAction& action) override HYADES_EXCLUDES(state_lock);

 private:
  /// Has FrameProgress do what an action says, with its job; does nothing where that is gone.
  template <class FrameAction>
  void with_job(const FrameAction& action,
                void (FrameProgress::*what)(ActiveJob&, const FrameAction&))
      HYADES_EXCLUDES(state_lock);
  void send(const Acknowledge& taken, Delivery* delivery) HYADES_REQUIRES(state_lock);
  void send(const Revoke& revoke) HYADES_REQUIRES(state_lock);
  void send(const Reject& reject, Delivery* delivery) HYADES_REQUIRES(state_lock);
  void note(const Conflict& conflict) HYADES_REQUIRES(state_lock);
  void note_expired(const std::vector<Action>& actions) HYADES_REQUIRES(state_lock);
  void end(const JobEnded& ended) HYADES_EXCLUDES(state_lock);

  ControllerContext& context_;
  JobTable& jobs_;
  WorkerTable& workers_;
  WorkerSessions& sessions_;
  JobFilms& films_;
  FrameProgress& frames_;
  DivergentWorkers& divergent_;
  JobRecords& records_;
  VideoMaker& videos_;
};

}  // namespace hyades::coordinator
