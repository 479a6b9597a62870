#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "coordinator/controller/worker_table.h"

namespace hyades::coordinator {

/// Workers that rendered a unit to other bits than others did, and the finished frames that they
/// had a part in since they could last be trusted: these are suspect, and rendered again.
class DivergentWorkers {
 public:
  DivergentWorkers(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs,
                   WorkerTable& workers)
      : context_(context), dispatcher_(dispatcher), jobs_(jobs), workers_(workers) {}
  /// Reads since when workers can be trusted; an error where the store cannot be read.
  core::Status load() HYADES_EXCLUDES(state_lock);

  // For the scheduler's actions.

  /// The worker rendered a unit of the frame rightly, after the frame was begun: what was finished
  /// before that shows nothing wrong of it. (Not after: its film may have come long ago.)
  void confirmed(const Confirmed& sure) HYADES_REQUIRES(state_lock);
  /// Stores that the worker diverges, with the suspicion of all finished frames that it had a part
  /// in since it could last be trusted; the scheduler hears when that is durable.
  void keep(RecordId record, const DivergentWorkerRecord& divergent) HYADES_REQUIRES(state_lock);

 private:
  /// A divergent worker, on its way into the store.
  struct Found {
    RecordId record{};
    StoredQuarantine worker;
    uint64_t since = 0;  ///< the moment when it could last be trusted
    StoredLine line;     ///< for the logs of jobs whose frames are suspect
  };
  bool store_trust() HYADES_EXCLUDES(state_lock);
  bool store(const Found& found) HYADES_EXCLUDES(state_lock);
  bool suspect_frames(const SuspectFrames& suspected) HYADES_EXCLUDES(state_lock);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  WorkerTable& workers_;
  /// The moments (JobTable::moment) at which another worker agreed, ascending, by what workers call
  /// themselves.
  std::map<std::string, std::vector<uint64_t>> trust_ HYADES_GUARDED_BY(state_lock);
  std::set<std::string> trust_to_store_ HYADES_GUARDED_BY(state_lock);
  bool storing_trust_ HYADES_GUARDED_BY(state_lock) = false;
};

}  // namespace hyades::coordinator
