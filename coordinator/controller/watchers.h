#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "coordinator/controller/job_table.h"
#include "coordinator/controller/shared.h"
#include "coordinator/controller/thread_pool.h"

namespace hyades::coordinator {

/// Those who want to hear whenever a job has changed. Thread-safe.
class Watchers {
 public:
  Watchers(Shared& shared, JobTable& jobs) : shared_(shared), jobs_(jobs) {}

  /// Calls `poke` (quickly, by another thread) whenever the job has changed, until unwatch.
  uint64_t watch(uint64_t job, std::function<void()> poke) HYADES_EXCLUDES(state_lock);
  void unwatch(uint64_t number) HYADES_EXCLUDES(state_lock);

  /// Pokes those whose jobs have changed since the last time.
  void poke_changed() HYADES_REQUIRES(state_lock);
  /// Pokes all who watch the job.
  void poke(uint64_t job) HYADES_REQUIRES(state_lock);

 private:
  struct Watch {
    uint64_t job = 0;
    uint64_t version = 0;
    std::function<void()> poke;
  };
  Shared& shared_;
  JobTable& jobs_;
  std::map<uint64_t, Watch> watches_ HYADES_GUARDED_BY(state_lock);
  uint64_t next_watch_ HYADES_GUARDED_BY(state_lock) = 1;
  ThreadPool pokes_{1, SIZE_MAX};
};

}  // namespace hyades::coordinator
