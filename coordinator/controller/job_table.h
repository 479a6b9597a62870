#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "coordinator/controller/active_job.h"
#include "coordinator/controller/controller_options.h"
#include "coordinator/controller/state_lock.h"

namespace hyades::coordinator {

/// The jobs that have not ended, and the logs of what happens to them.
class JobTable {
 public:
  using Jobs = std::map<JobId, std::unique_ptr<ActiveJob>>;

  /// A job that is being recovered by one thread, and is in the table soon.
  struct Recovering {
    std::string owner;
    JobRoom room;
  };
  /// Its owner alone recovers the job, as long as it lives.
  class Recovery {
   public:
    Recovery(JobTable& table, uint64_t job) : table_(table), job_(job) {}
    Recovery(const Recovery&) = delete;
    Recovery& operator=(const Recovery&) = delete;
    ~Recovery();

   private:
    JobTable& table_;
    uint64_t job_;
  };

  explicit JobTable(StateMutex& mutex) : mutex_(mutex) {}

  /// The open job; null where it has ended, waits to be recovered, or is none.
  ActiveJob* find(JobId job) HYADES_REQUIRES(state_lock);
  ActiveJob* find(uint64_t job) HYADES_REQUIRES(state_lock) { return find(JobId{job}); }
  const Jobs& all() const HYADES_REQUIRES(state_lock) { return jobs_; }
  /// Puts the job into the table.
  void add(std::unique_ptr<ActiveJob> job) HYADES_REQUIRES(state_lock);
  /// Takes the job out; until left() it is on its way out.
  std::unique_ptr<ActiveJob> take_out(uint64_t job) HYADES_REQUIRES(state_lock);
  /// Nothing is left of a job that was taken out.
  void left(uint64_t job) HYADES_EXCLUDES(state_lock);
  /// Waits until nothing is left of a job whose end is being stored, or `time` has come, or `stop`;
  /// whether it was awaited.
  bool wait_until_left(uint64_t job, TimePoint time, const std::atomic<bool>& stop)
      HYADES_EXCLUDES(state_lock);
  /// Wakes those who wait for jobs to leave.
  void wake() { left_.notify_all(); }
  /// Drops all of them.
  void clear() HYADES_EXCLUDES(state_lock);

  /// Jobs that are open, but could not be recovered yet; their reasons say why.
  const std::map<uint64_t, StoredJob>& waiting() const HYADES_REQUIRES(state_lock) {
    return waiting_;
  }
  /// The job is among those that wait from now on; its reason says why.
  void wait_for_recovery(StoredJob job) HYADES_REQUIRES(state_lock);
  void no_longer_waits(uint64_t job) HYADES_REQUIRES(state_lock) { waiting_.erase(job); }
  /// What waits says `reason` from now on.
  void still_waits(uint64_t job, const std::string& reason) HYADES_REQUIRES(state_lock);
  /// Jobs that are being recovered: nobody else may recover, cancel or remove them meanwhile.
  const std::map<uint64_t, Recovering>& recovering() const HYADES_REQUIRES(state_lock) {
    return recovering_;
  }
  /// Lets the caller recover the job; null where somebody does so already.
  std::unique_ptr<Recovery> begin_recovery(uint64_t job, Recovering what)
      HYADES_REQUIRES(state_lock);

  /// The number of the frame that was last finished: it grows over all jobs and runs of the
  /// coordinator.
  uint64_t moment() const HYADES_REQUIRES(state_lock) { return moment_; }
  /// The number of the frame that is finished next.
  uint64_t next_moment() HYADES_REQUIRES(state_lock) { return ++moment_; }
  /// Numbers go on after this one.
  void begin_moments(uint64_t moment) HYADES_REQUIRES(state_lock) { moment_ = moment; }

  /// Adds a line to the job's log, and to the coordinator's.
  static void note(ActiveJob& job, v1::LogLevel level, std::optional<int32_t> frame,
                   const std::string& worker, const std::string& text,
                   const core::Unit* unit = nullptr) HYADES_REQUIRES(state_lock);

 private:
  StateMutex& mutex_;
  Jobs jobs_ HYADES_GUARDED_BY(state_lock);
  std::map<uint64_t, StoredJob> waiting_ HYADES_GUARDED_BY(state_lock);
  std::map<uint64_t, Recovering> recovering_ HYADES_GUARDED_BY(state_lock);
  std::set<uint64_t> leaving_
      HYADES_GUARDED_BY(state_lock);  ///< taken out, but their log is still open
  core::CondVar left_;
  uint64_t moment_ HYADES_GUARDED_BY(state_lock) = 0;
};

}  // namespace hyades::coordinator
