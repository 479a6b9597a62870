#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "coordinator/controller/controller_options.h"
#include "coordinator/controller/retry_queue.h"
#include "coordinator/controller/state_lock.h"
#include "coordinator/state/job_store.h"
#include "farm/content_store.h"

namespace hyades::coordinator {

class Meters;

/// What all parts of a controller have in common. It begins before them and ends after them.
struct Shared {
  Shared(ControllerOptions options, std::unique_ptr<JobStore> store,
         std::unique_ptr<farm::ContentStore> assets, uint64_t incarnation);
  ~Shared();

  std::string output_folder(uint64_t job) const;
  std::string films_folder(uint64_t job) const;

  const ControllerOptions options;
  const std::unique_ptr<JobStore> store;
  const std::unique_ptr<farm::ContentStore> assets;
  const uint64_t incarnation;
  const int64_t started_ms;
  const std::unique_ptr<Meters> meters;
  std::atomic<bool> stop{false};  ///< the controller ends
  StateMutex mutex;
  /// One submission at a time, and none while jobs or unused files are removed.
  std::timed_mutex submissions;
  /// How long a caller waits for the submissions before his.
  static constexpr std::chrono::seconds kSubmissionPatience{2};
  /// Stores what has changed: by the job's id, or kWorkersKey.
  RetryQueue background{2};
  static constexpr uint64_t kWorkersKey = 0;  ///< no job has this number
};

}  // namespace hyades::coordinator
