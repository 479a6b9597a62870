// What is out, and with whom: for those who explain and log.
#include <utility>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {

std::vector<UnitInHand> Scheduler::units_of(WorkerId worker) const {
  std::vector<UnitInHand> units;
  const auto found = workers_.find(worker);
  if (found == workers_.end()) return units;
  for (const uint64_t number : found->second.leases) {
    for (UnitInHand& unit : units_of(worker, LeaseId{options_.incarnation, number})) {
      units.push_back(std::move(unit));
    }
  }
  return units;
}

std::vector<std::pair<WorkerId, UnitInHand>> Scheduler::units_of(JobId job) const {
  std::vector<std::pair<WorkerId, UnitInHand>> units;
  const auto found = jobs_.find(job);
  if (found == jobs_.end()) return units;
  for (const auto& [worker, leases] : found->second->workers) {
    for (UnitInHand& unit : units_of(worker)) {
      if (unit.job == job) units.emplace_back(worker, std::move(unit));
    }
  }
  return units;
}

}  // namespace hyades::coordinator
