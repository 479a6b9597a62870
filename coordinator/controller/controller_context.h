#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "coordinator/controller/controller_options.h"
#include "coordinator/controller/film_copies.h"
#include "coordinator/controller/job_documents.h"
#include "coordinator/controller/lease_proof.h"
#include "coordinator/controller/state_lock.h"
#include "coordinator/film_store/film_logs.h"
#include "coordinator/job_store/job_store.h"
#include "farm/content_store.h"
#include "farm/retry_queue.h"

namespace hyades::coordinator {

struct ActiveJob;
class Meters;

/// What all parts of a controller have in common. It is made before them and outlives them.
struct ControllerContext {
  ControllerContext(ControllerOptions options, std::unique_ptr<JobStore> store,
                    std::unique_ptr<FilmLogs> films, std::unique_ptr<farm::ContentStore> assets,
                    uint64_t incarnation, std::string secret);
  ~ControllerContext();

  /// Where the job's finished files lie.
  std::string output_folder(uint64_t job) const;

  const ControllerOptions options;
  const std::unique_ptr<JobStore> store;
  const std::unique_ptr<FilmLogs> films;
  const std::unique_ptr<farm::ContentStore> assets;
  JobDocuments documents{*assets, options.document_memory};
  core::Mutex whole_records;  ///< FilmStoreOptions::whole_records
  FilmCopies film_copies{options.film_memory / 4};
  const uint64_t incarnation;  ///< the number of this start
  const LeaseProofs proofs;
  const int64_t started_ms;  ///< since 1970, UTC
  const std::unique_ptr<Meters> meters;
  std::atomic<bool> stop{false};  ///< the controller ends
  StateMutex mutex;               ///< behind state_lock
  /// One submission at a time, and none while jobs or unused files are removed. It guards no member
  /// (core/base/mutex.h).
  std::timed_mutex submissions;
  /// Waits for other submissions, two seconds at most; a lock that is not held if that is not
  /// enough.
  std::unique_lock<std::timed_mutex> wait_for_submissions() {
    return std::unique_lock(submissions, std::chrono::seconds(2));
  }
  /// Stores what has changed; tasks are kept apart by the job's id, or kWorkersKey. Half of the
  /// threads are for other owners than the one who has most to store.
  farm::RetryQueue background{4, std::chrono::seconds(1), 2};
  static constexpr uint64_t kWorkersKey = 0;  ///< no job has this number
  /// Adds a task of an open job's, for its owner.
  void in_background(const ActiveJob& active, farm::RetryQueue::Task task)
      HYADES_REQUIRES(state_lock);
  /// Waits for what is left of jobs that have ended, by their ids: seconds, where much of a film
  /// has still to be written.
  farm::RetryQueue closing{4, std::chrono::seconds(1), 2};
};

}  // namespace hyades::coordinator
