#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "coordinator/controller/worker_table.h"

namespace hyades::coordinator {

/// Workers that rendered a unit to other bits than others did, and the finished frames that they
/// had a part in since they could last be trusted: these are in doubt, and rendered again.
class DivergentWorkers {
 public:
  DivergentWorkers(Shared& shared, Dispatcher& dispatcher, JobTable& jobs, WorkerTable& workers)
      : shared_(shared), dispatcher_(dispatcher), jobs_(jobs), workers_(workers) {}
  /// Reads since when workers can be trusted.
  core::Status load() HYADES_EXCLUDES(state_lock);

  // For the scheduler's actions.

  void confirmed(const Confirmed& sure) HYADES_REQUIRES(state_lock);
  /// Stores that the worker diverges; the scheduler hears when that is durable.
  void keep(RecordId record, const DivergentWorkerRecord& odd) HYADES_REQUIRES(state_lock);

 private:
  /// On its way into the store.
  struct Found {
    RecordId record{};
    StoredQuarantine worker;
    uint64_t since = 0;
    StoredLine line;
  };
  bool store_trust() HYADES_EXCLUDES(state_lock);
  bool store(const Found& odd) HYADES_EXCLUDES(state_lock);
  bool doubt_frames(const JobFrames& doubted) HYADES_EXCLUDES(state_lock);

  Shared& shared_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  WorkerTable& workers_;
  /// By what workers call themselves: when (JobTable::moment) another agreed with it, ascending.
  std::map<std::string, std::vector<uint64_t>> trust_ HYADES_GUARDED_BY(state_lock);
  std::set<std::string> trust_to_store_ HYADES_GUARDED_BY(state_lock);
  bool storing_trust_ HYADES_GUARDED_BY(state_lock) = false;
};

}  // namespace hyades::coordinator
