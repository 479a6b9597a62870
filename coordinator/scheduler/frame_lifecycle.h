#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "coordinator/scheduler/affinity.h"
#include "coordinator/scheduler/leases.h"
#include "coordinator/scheduler/pending_records.h"

namespace hyades::coordinator {

/// Frames: opened, finished, begun again, over.
class FrameLifecycle {
 public:
  FrameLifecycle(const SchedulerOptions& options, Step& step, ScheduledJobs& jobs,
                 ScheduledWorkers& workers, FilmBudget& films, Leases& leases,
                 PendingRecords& records, const Affinity& affinity)
      : options_(options),
        step_(step),
        jobs_(jobs),
        workers_(workers),
        films_(films),
        leases_(leases),
        records_(records),
        affinity_(affinity) {}

  void on(const FrameOpened& e);
  void on(const FrameRefused& e);
  void on(const FilmSetAside& e);
  void on(const FinishDone& e);
  void on(const FinishFailed& e);
  void on(const TileJudged& e);

  /// Opens frames while there is less than half a frame left to lease, or too little for all
  /// threads, or those that are open have workers enough: the next scene is there before the last
  /// unit of this one is gone, and not much earlier.
  void open(ScheduledJob& job);
  /// Whether the film of the frame, which is in memory, can be set aside.
  static bool may_leave(const FrameSlot& slot);
  /// Has the film of a frame that may_leave() set aside.
  void set_aside(const ScheduledJob& job, FrameSlot& slot);
  /// Every film of the frame is durable: its outputs are made.
  void finish(ScheduledJob& job, FrameSlot& slot);
  /// Finishes a frame that is being rendered, if every film of it is durable and none is suspect.
  void finish_if_complete(ScheduledJob& job, FrameSlot& slot);
  /// Has the tile judged, if all films that are planned of it are durable.
  void judge_if_due(const ScheduledJob& job, FrameSlot& slot, uint32_t tile);
  /// Gives the frame up, which is in flight, for this reason.
  void fail(ScheduledJob& job, FrameSlot& slot, std::string reason);
  /// A unit of the frame is hopeless for workers of its class, to which this one belongs: where
  /// the class may be an invention and others are there it begins again with them, else it fails.
  void fail_or_leave(ScheduledJob& job, FrameSlot& slot, WorkerId worker, std::string reason);
  /// Begins the frame again, which is in flight. Films of it that are on their way to the disk get
  /// there before the record that says so, and are void with it.
  void restart(ScheduledJob& job, FrameSlot& slot);
  /// Begins failed frames of the job again, in their order from slot bring_back_from on: some, and
  /// the next ones when these are durable. There may be a million.
  void bring_back_failed(ScheduledJob& job);
  /// Begins a frame again that is over, or has films from before a restart of the coordinator and
  /// was not opened since.
  void bring_back(ScheduledJob& job, FrameSlot& slot);
  /// Has the suspect tiles of a frame that is being rendered voided. (Where its outputs are being
  /// made, that happens once they are.)
  void void_suspect_tiles(const ScheduledJob& job, FrameSlot& slot);

  /// Goes on with frames that are to be finished or judged and whose films were set aside: those of
  /// which `fits` says so, in order. Whoever has taken most of the room himself holds up nobody.
  void serve_waiting(
      const std::function<bool(const ScheduledJob& job, const FrameSlot& slot)>& fits);
  /// Whether one of them is next in line for room.
  bool film_is_next() const { return film_is_next_; }
  /// Whether a frame of this owner's does so.
  bool film_is_next_of(const std::string& owner) const { return owners_waiting_.contains(owner); }

  /// It is durable that the frame is done or has failed, as `phase` says.
  void over(ScheduledJob& job, FrameSlot& slot, FramePhase phase);
  /// It is durable that the frame begins again: it waits to be opened.
  void restarted(ScheduledJob& job, FrameSlot& slot);

  /// Frames whose class has been gone for too long, or may be somebody's invention and gets on
  /// with them no more, begin again, if there is somebody else to render them. `leasing`: units are
  /// leased, so that whoever delivers nothing is to blame.
  void restart_stranded(bool leasing);
  /// When restart_stranded() may have something to do next.
  std::optional<TimePoint> next_wake() const;

 private:
  bool await_film(const ScheduledJob& job, FrameSlot& slot);
  void go_on(ScheduledJob& job, FrameSlot& slot);
  bool goes_back(ScheduledJob& job, FrameSlot& slot);
  void say_finish(const ScheduledJob& job, const FrameSlot& slot);
  void reopen(ScheduledJob& job, FrameSlot& slot);
  bool note_left(FrameSlot& slot, Origin origin) const;
  bool is_orphaned(const ScheduledJob& job, FrameSlot& slot);
  std::optional<TimePoint> stands_still_since(const ScheduledJob& job, FrameSlot& slot,
                                              bool leasing);

  const SchedulerOptions& options_;
  Step& step_;
  ScheduledJobs& jobs_;
  ScheduledWorkers& workers_;
  FilmBudget& films_;
  Leases& leases_;
  PendingRecords& records_;
  const Affinity& affinity_;
  TimePoint next_look_;  ///< of restart_stranded()
  uint64_t last_question_ = 0;
  std::deque<FrameId> waiting_;  ///< of which FrameSlot::awaits_film, and others by now
  bool film_is_next_ = false;
  std::set<std::string> owners_waiting_;  ///< of those looked at lately
};

}  // namespace hyades::coordinator
