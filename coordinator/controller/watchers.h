#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/job_table.h"
#include "farm/thread_pool.h"

namespace hyades::coordinator {

/// Tells those who want to hear of it that a job has changed. Thread-safe.
class Watchers {
 public:
  Watchers(ControllerContext& context, JobTable& jobs) : context_(context), jobs_(jobs) {}

  /// Calls `poke`, which has to be quick, by another thread whenever the job has changed, until
  /// unwatch() of the number that is returned.
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
  ControllerContext& context_;
  JobTable& jobs_;
  std::map<uint64_t, Watch> watches_ HYADES_GUARDED_BY(state_lock);
  uint64_t next_watch_ HYADES_GUARDED_BY(state_lock) = 1;
  farm::ThreadPool pokes_{1, SIZE_MAX};
};

}  // namespace hyades::coordinator
