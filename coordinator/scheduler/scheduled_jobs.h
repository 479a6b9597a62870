#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "coordinator/scheduler/pending_records.h"
#include "coordinator/scheduler/scheduled_job.h"
#include "coordinator/scheduler/step.h"

namespace hyades::coordinator {

/// All jobs of one owner at one priority; there while there are some.
struct FairShare {
  int priority = 0;
  uint64_t serial = 0;   ///< of the job that came first
  uint64_t jobs = 0;     ///< how many
  uint64_t running = 0;  ///< leased units
  uint64_t served = 0;   ///< when it got its last lease, in order; 0: it had none
  /// Jobs that have work for some worker.
  struct Ready {
    const NeedsGroup* group = nullptr;
    std::map<uint64_t, ScheduledJob*> jobs;  ///< by serial
  };
  std::map<uint64_t, Ready> ready;  ///< by what they ask of workers: NeedsGroup::serial
};

/// A frame and its job; both null where one of them is not there.
struct FoundFrame {
  ScheduledJob* job = nullptr;
  FrameSlot* slot = nullptr;
};

/// The jobs that have not ended, and who is next in line: what each owner has out, and which jobs
/// have work.
class ScheduledJobs {
 public:
  /// By priority and owner.
  using Shares = std::map<std::pair<int, std::string>, FairShare>;
  /// Highest priority first, then who has least, then whose last lease is longest ago, then
  /// by age.
  using ShareOrder = std::tuple<int, uint64_t, uint64_t, uint64_t>;

  ScheduledJobs(Step& step, PendingRecords& records) : step_(step), records_(records) {}

  ScheduledJob* find(JobId id) const;
  FoundFrame find_frame(const FrameId& id) const;
  const std::map<JobId, std::unique_ptr<ScheduledJob>>& all() const { return jobs_; }
  /// Adds a job that is not there yet. Its frames wait. `count` says how many workers there are
  /// that have what it needs, where no other job needs that.
  ScheduledJob& add(JobId id, const JobPlan& plan, const Needs& needs,
                    const std::function<uint64_t(const Needs&)>& count);
  /// There is a worker with these tags and so much memory more, or less.
  void count_worker(const Worker& worker, bool one_more);
  /// Forgets the job, and what it had on its way to the disk, and says so.
  void end(ScheduledJob& job, bool cancelled);
  /// Ends the job where all its frames are done or have failed; it must not be used any more then.
  void end_if_over(ScheduledJob& job);

  /// The job has `change` more units out.
  void count_running(ScheduledJob& job, int64_t change);
  /// Looks at what the job has to lease. To be called whenever that may have changed.
  void update_offer(ScheduledJob& job);
  /// Gives the job another priority, and a place among its owner's jobs there.
  void reprioritise(ScheduledJob& job, int priority);

  /// Free batches and disputed units of all jobs.
  uint64_t offered() const { return offered_; }
  /// Shares that have work; the first is next in line.
  const std::map<ShareOrder, const FairShare*>& ready_shares() const { return ready_shares_; }
  const Shares& shares() const { return shares_; }

 private:
  void join_share(ScheduledJob& job);
  void leave_share(ScheduledJob& job);
  void list_ready(ScheduledJob& job, bool ready);
  static bool has_work(const ScheduledJob& job) { return job.offer > 0 && job.group->workers > 0; }

  Step& step_;
  PendingRecords& records_;
  std::map<JobId, std::unique_ptr<ScheduledJob>> jobs_;
  uint64_t next_serial_ = 1;
  uint64_t last_served_ = 0;
  Shares shares_;
  std::map<Needs, NeedsGroup> needs_;  ///< of all jobs
  uint64_t next_group_ = 1;
  std::map<ShareOrder, const FairShare*> ready_shares_;
  uint64_t offered_ = 0;
};

}  // namespace hyades::coordinator
