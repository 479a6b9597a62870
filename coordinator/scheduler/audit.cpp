// What is wrong with the books.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {

std::string Scheduler::audit() const {
  std::map<std::pair<JobId, uint32_t>, size_t> out;
  for (const auto& [number, lease] : leases_) {
    if (lease.units.empty()) return fmt::format("lease {} holds nothing", number);
    const auto worker = workers_.find(lease.worker);
    if (worker == workers_.end() ||
        std::count(worker->second.leases.begin(), worker->second.leases.end(), number) != 1) {
      return fmt::format("lease {} is not on its worker's list", number);
    }
    const auto job = jobs_.find(lease.job);
    if (job == jobs_.end()) return fmt::format("lease {} belongs to no job", number);
    const FrameSlot& slot = job->second->slots[lease.slot];
    if (!slot.books) return fmt::format("lease {} belongs to a frame that is over", number);
    for (const Extent& e : lease.units) {
      const Assignment* a = slot.books->find_assignment(e);
      if (a == nullptr) return fmt::format("lease {} holds a unit that nobody is assigned", number);
      out[{lease.job, lease.slot}] += 1;
    }
  }
  std::vector<uint64_t> running(shares_.size());
  uint64_t films = 0;
  for (const auto& [id, job] : jobs_) {
    for (uint32_t i = 0; i < job->slots.size(); ++i) {
      const FrameSlot& slot = job->slots[i];
      films += slot.film ? job->plan.film_bytes : 0;
      const auto units = out.find({id, i});
      const size_t leased = units == out.end() ? 0 : units->second;
      running[job->share] += leased;
      const bool listed = std::count(job->in_flight.begin(), job->in_flight.end(), i) == 1;
      if (listed != slot.in_flight())
        return fmt::format("frame {} is in the wrong list", slot.frame);
      if (!slot.books) continue;
      if (slot.books->holders() != leased) {
        return fmt::format("frame {}: {} units assigned, {} leased", slot.frame,
                           slot.books->holders(), leased);
      }
      if (std::string wrong = slot.books->audit(); !wrong.empty()) {
        return fmt::format("frame {}: {}", slot.frame, wrong);
      }
    }
  }
  for (size_t i = 0; i < shares_.size(); ++i) {
    if (shares_[i].running != running[i]) return "an owner's running units are miscounted";
  }
  if (films != films_) return fmt::format("films take {} bytes, {} counted", films, films_);
  return {};
}

}  // namespace hyades::coordinator
