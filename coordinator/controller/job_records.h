#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {

class JobQueries;
class Watchers;

/// Gets what became of a change of a job: a status, and where that is OK the job as it is now.
using JobReply = std::function<void(const grpc::Status&, const v1::Job&)>;

/// Stores what changes in open jobs, their logs and their ends, in the background, and answers
/// those who wait for that.
class JobRecords {
 public:
  JobRecords(ControllerContext& context, JobTable& jobs, JobQueries& queries, Watchers& watchers)
      : context_(context), jobs_(jobs), queries_(queries), watchers_(watchers) {}

  /// Has stored, in the background, what has changed of an open job. All of a job's rows are stored
  /// by its tasks, one after the other, and each as the job is then: what is stored last is what
  /// was last.
  void store(ActiveJob& active) HYADES_REQUIRES(state_lock);
  /// Calls `then` once, by another thread: when the job is stored as it is now, or after half a
  /// second with UNAVAILABLE.
  void when_stored(uint64_t job, JobReply then) HYADES_REQUIRES(state_lock);
  /// Calls `then` once, by another thread, when every task already queued under `key` has run, or
  /// after half a second with UNAVAILABLE. With the job of that number, where `key` is one's.
  void when_done(uint64_t key, JobReply then) HYADES_REQUIRES(state_lock);
  /// Answers, with UNAVAILABLE, those whose half second is over at `now`; all, where the controller
  /// ends.
  void answer_late(TimePoint now) HYADES_EXCLUDES(state_lock);
  /// The job ends: it leaves memory once that is stored. `why` says why it has failed although its
  /// frames have not.
  void end(ActiveJob& active, bool cancelled, const std::string& why) HYADES_REQUIRES(state_lock);
  /// Updates speeds, and has accounts and lines of logs stored; to be called from time to time.
  void look_after(TimePoint now, bool disk_full, const Scheduler& scheduler)
      HYADES_REQUIRES(state_lock);
  /// Stores the accounts of open jobs as they are at `now`: nobody works on them any more. To be
  /// called at the end, when no task is left that could store a job.
  void store_accounts(TimePoint now) HYADES_EXCLUDES(state_lock);

 private:
  struct PendingReply {
    uint64_t number = 0;     ///< grows
    uint64_t job = 0;        ///< or kWorkersKey
    bool for_tasks = false;  ///< when_done()
    TimePoint give_up;
    JobReply then;
  };
  void wait(uint64_t key, bool for_tasks, JobReply then) HYADES_REQUIRES(state_lock);
  void answer(uint64_t key, uint64_t number) HYADES_EXCLUDES(state_lock);
  bool store_now(uint64_t id) HYADES_EXCLUDES(state_lock);
  bool store_end(uint64_t id) HYADES_EXCLUDES(state_lock);
  bool store_lines(JobId id) HYADES_EXCLUDES(state_lock);
  std::vector<PendingReply> take_replies(const std::function<bool(const PendingReply&)>& which)
      HYADES_REQUIRES(state_lock);

  ControllerContext& context_;
  JobTable& jobs_;
  JobQueries& queries_;
  Watchers& watchers_;
  std::vector<PendingReply> replies_ HYADES_GUARDED_BY(state_lock);
  uint64_t next_reply_ HYADES_GUARDED_BY(state_lock) = 1;
};

}  // namespace hyades::coordinator
