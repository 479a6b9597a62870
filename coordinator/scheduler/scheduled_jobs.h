#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "coordinator/scheduler/scheduled_job.h"
#include "coordinator/scheduler/step.h"

namespace hyades::coordinator {

/// All jobs of one owner at one priority.
struct FairShare {
  int priority = 0;
  std::string owner;
  uint64_t running = 0;                     ///< leased units
  std::map<uint64_t, ScheduledJob*> ready;  ///< jobs that have work, by serial
};

/// The jobs that have not ended, and whose turn it is: what each owner has out, and which jobs have
/// work.
class ScheduledJobs {
 public:
  /// Highest priority first, then who has least, then by age: the last is an index for share().
  using ShareOrder = std::tuple<int, uint64_t, uint32_t>;

  explicit ScheduledJobs(Step& step) : step_(step) {}

  ScheduledJob* find(JobId id) const;
  FrameSlot* find_frame(const FrameId& id) const;
  const std::map<JobId, std::unique_ptr<ScheduledJob>>& all() const { return jobs_; }
  /// `id` is not there yet.
  ScheduledJob& add(JobId id, const JobPlan& plan);
  /// Forgets the job and says so.
  void end(ScheduledJob& job, bool cancelled);
  void end_if_over(ScheduledJob& job);

  /// The job has `change` more units out.
  void count_running(ScheduledJob& job, int64_t change);
  /// Looks at what the job has to lease. To be called whenever that may have changed.
  void update_offer(ScheduledJob& job);
  void reprioritise(ScheduledJob& job, int priority);

  /// Free batches and disputed units of all jobs.
  uint64_t offered() const { return offered_; }
  /// Shares that have work, in turn.
  const std::set<ShareOrder>& ready_shares() const { return ready_shares_; }
  const FairShare& share(uint32_t index) const { return shares_[index]; }
  const std::vector<FairShare>& shares() const { return shares_; }

 private:
  uint32_t share_of(int priority, const std::string& owner);
  void list_ready(ScheduledJob& job, bool ready);

  Step& step_;
  std::map<JobId, std::unique_ptr<ScheduledJob>> jobs_;
  uint64_t next_serial_ = 1;
  std::vector<FairShare> shares_;
  std::map<std::pair<int, std::string>, uint32_t> share_index_;
  std::set<ShareOrder> ready_shares_;
  uint64_t offered_ = 0;
};

}  // namespace hyades::coordinator
