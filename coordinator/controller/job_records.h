#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/controller/job_table.h"
#include "coordinator/controller/shared.h"

namespace hyades::coordinator {

class JobQueries;
class Watchers;

/// Answers who wants something changed: a status, and where that is OK the job as it is now.
using JobReply = std::function<void(const grpc::Status&, const v1::Job&)>;

/// Stores what changes in open jobs, their logs and their ends, in the background, and answers
/// those who wait for that.
class JobRecords {
 public:
  JobRecords(Shared& shared, JobTable& jobs, JobQueries& queries, Watchers& watchers)
      : shared_(shared), jobs_(jobs), queries_(queries), watchers_(watchers) {}

  /// Stores what has changed of an open job.
  void store(ActiveJob& active) HYADES_REQUIRES(state_lock);
  /// Calls `then` once, by another thread: when the job is stored as it is now, or after half a
  /// second with UNAVAILABLE.
  void when_stored(uint64_t job, JobReply then) HYADES_REQUIRES(state_lock);
  /// Answers those who have waited for long enough; all, where the controller ends.
  void answer_late(TimePoint now) HYADES_EXCLUDES(state_lock);
  /// The job ends: it leaves memory once that is stored. `why` says why it has failed although its
  /// frames have not.
  void end(ActiveJob& active, bool cancelled, const std::string& why) HYADES_REQUIRES(state_lock);
  /// Speeds, accounts and lines of the logs; from time to time.
  void look_after(TimePoint now, bool disk_full) HYADES_REQUIRES(state_lock);

 private:
  struct PendingReply {
    uint64_t number = 0;  ///< grows
    uint64_t job = 0;
    TimePoint give_up;
    JobReply then;
  };
  bool store_now(uint64_t id) HYADES_EXCLUDES(state_lock);
  bool store_end(uint64_t id) HYADES_EXCLUDES(state_lock);
  bool store_lines(JobId id) HYADES_EXCLUDES(state_lock);
  std::vector<PendingReply> take_replies(const std::function<bool(const PendingReply&)>& which)
      HYADES_REQUIRES(state_lock);

  Shared& shared_;
  JobTable& jobs_;
  JobQueries& queries_;
  Watchers& watchers_;
  std::vector<PendingReply> replies_ HYADES_GUARDED_BY(state_lock);
  uint64_t next_reply_ HYADES_GUARDED_BY(state_lock) = 1;
};

}  // namespace hyades::coordinator
