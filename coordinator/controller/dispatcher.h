#pragma once

#include <utility>
#include <variant>
#include <vector>

#include "coordinator/controller/state_lock.h"
#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {

struct Delivery;
class Turn;

/// Actions that are carried out after the state lock is let go of: those of one turn in their
/// order, those of different turns, by different threads, in any.
using DeferredAction =
    std::variant<Merge, FinishFrame, FrameDone, FrameFailed, TileVoided, FrameReopened, JobEnded>;

/// The scheduler, and who does what it wants done. A Turn tells it of events.
class Dispatcher {
 public:
  /// Does what the scheduler wants done.
  class ActionHandler {
   public:
    virtual ~ActionHandler() = default;
    /// Does at once what others have to hear of in order; the rest is deferred by `turn`.
    /// `delivery` came with the event, if it is a result.
    virtual void act(const std::vector<Action>& actions, Turn& turn, Delivery* delivery)
        HYADES_REQUIRES(state_lock) = 0;
    /// Does what was deferred, at the end of its turn.
    virtual void carry_out(const DeferredAction& action) HYADES_EXCLUDES(state_lock) = 0;
  };

  Dispatcher(StateMutex& mutex, const SchedulerOptions& options)
      : mutex_(mutex), scheduler_(options) {}
  /// Before the first event.
  void set_action_handler(ActionHandler& handler) { handler_ = &handler; }
  const Scheduler& scheduler() const HYADES_REQUIRES(state_lock) { return scheduler_; }

 private:
  friend class Turn;
  StateMutex& mutex_;
  ActionHandler* handler_ = nullptr;
  Scheduler scheduler_ HYADES_GUARDED_BY(state_lock);
};

/// Holds the state lock for as long as it lives and tells the scheduler of events. What follows and
/// has to wait for the lock is carried out at its end.
class HYADES_SCOPED_CAPABILITY Turn {
 public:
  explicit Turn(Dispatcher& dispatcher) HYADES_ACQUIRE(state_lock);
  ~Turn() HYADES_RELEASE();
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  /// Tells the scheduler of an event and has its actions done. `delivery`: what came with it, where
  /// it is a result.
  void tell(const Event& event, Delivery* delivery = nullptr) HYADES_REQUIRES(state_lock);
  /// Has the action carried out at the end of the turn; for ActionHandler::act().
  void defer(DeferredAction action) { deferred_.push_back(std::move(action)); }

 private:
  Dispatcher& dispatcher_;
  StateLock lock_;
  std::vector<DeferredAction> deferred_;
};

}  // namespace hyades::coordinator
