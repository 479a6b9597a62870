#pragma once

#include <cstdint>
#include <optional>

#include "coordinator/scheduler/frame_lifecycle.h"
#include "coordinator/scheduler/hedged_copies.h"

namespace hyades::coordinator {

/// Which unit a worker gets next.
class Granting {
 public:
  Granting(const SchedulerOptions& options, Step& step, ScheduledJobs& jobs,
           ScheduledWorkers& workers, FilmBudget& films, Leases& leases, PendingRecords& records,
           Affinity& affinity, HedgedCopies& copies, FrameLifecycle& frames)
      : options_(options),
        step_(step),
        jobs_(jobs),
        workers_(workers),
        films_(films),
        leases_(leases),
        records_(records),
        affinity_(affinity),
        copies_(copies),
        frames_(frames) {}

  void on(const WorkRequested& e);
  void on(const LeasingHeld& e);
  void on(const FrameWatched& e);
  void on(const Tick& e);

  /// Whether units are leased now: what is delivered can be made durable.
  bool may_lease() const { return !held_ && step_.now >= records_.blocked_until(); }
  /// Serves those who wait, where something has turned up for them.
  void dispatch();
  /// When somebody who waits may be served without any other event.
  std::optional<TimePoint> next_wake() const;
  /// A job is paused: whether its films can be set aside is looked at soon.
  void look_for_room() { next_room_ = step_.now; }
  /// Whether a frame of the job could begin if there were more room for films.
  bool waits_for_film(const ScheduledJob& job) const;

 private:
  /// Whether a worker had better take units of a frame that is next in line.
  enum class Suits : uint8_t {
    no,
    if_nothing_else,  ///< the frame has workers enough
    yes,
  };

  void serve(WorkerId id, Worker& worker, bool units, bool copies);
  void serve_waiting(WorkerId id, bool copies);
  void offer_copies();
  bool grant(WorkerId id, Worker& worker);
  bool grant_from(const FramePlace& place, WorkerId id, Worker& worker, bool ahead);
  bool grant_check(const FramePlace& place, WorkerId id, Worker& worker, const MayTry& may_try);
  std::optional<FramePlace> next_in_line(WorkerId id, const Worker& worker, bool fresh);
  std::optional<FramePlace> next_of(const FairShare& share, WorkerId id, const Worker& worker,
                                    bool fresh, bool& begun);
  Suits suits_at(const FramePlace& place, WorkerId id, const Worker& worker, bool fresh);
  std::optional<uint32_t> find_pass(const ScheduledJob& job, WorkerId id, const Worker& worker,
                                    bool begun) const;
  std::optional<FramePlace> find_loaded(WorkerId id, const Worker& worker,
                                        const ScheduledJob& first, bool loads) const;
  bool has_units_for(const ScheduledJob& job, const FrameSlot& slot, WorkerId id,
                     const Worker& worker) const;
  bool has_work_for(const ScheduledJob& job, const FrameSlot& slot, WorkerId id,
                    const Worker& worker) const;
  uint32_t run_length_of(const ScheduledJob& job, const FrameSlot& slot, uint32_t tile) const;
  bool film_fits(const ScheduledJob& job, const FrameSlot& slot) const;
  bool any_film_in_work() const;
  void make_room();

  const SchedulerOptions& options_;
  Step& step_;
  ScheduledJobs& jobs_;
  ScheduledWorkers& workers_;
  FilmBudget& films_;
  Leases& leases_;
  PendingRecords& records_;
  Affinity& affinity_;
  HedgedCopies& copies_;
  FrameLifecycle& frames_;
  bool held_ = false;          ///< LeasingHeld
  TimePoint served_;           ///< when those who wait were served last because time had passed
  uint64_t last_offered_ = 0;  ///< the place of whoever was offered copies last
  /// When it is looked at next which films can be set aside; nothing while none has to.
  std::optional<TimePoint> next_room_;
  bool crammed_ = false;  ///< films have no room, and none of those that are there can be set aside
  bool turned_away_ =
      false;  ///< somebody came too late for a frame, or rests: to be looked at again
};

}  // namespace hyades::coordinator
