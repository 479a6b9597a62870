#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "core/film/unit.h"

namespace hyades::coordinator {

/// A unit whose film came: who rendered it, and when.
struct TimedUnit {
  std::string worker;  ///< its name
  core::Unit unit;
  int64_t begun_ms = 0;  ///< since 1970, UTC: the end less what its thread took for it
  int64_t ended_ms = 0;
};

/// What was rendered where and when, of the jobs that last had something rendered: in memory only,
/// for those who look for what takes long. Not thread-safe.
class Timelines {
 public:
  struct OfJob {
    std::deque<TimedUnit> units;  ///< in the order in which they came
    uint64_t dropped = 0;         ///< older ones
  };

  void note(uint64_t job, TimedUnit unit) {
    OfJob& timeline = jobs_[job];
    timeline.units.push_back(std::move(unit));
    if (timeline.units.size() > kMostUnits) {
      timeline.units.pop_front();
      ++timeline.dropped;
    }
    if (jobs_.size() <= kMostJobs) return;
    // What was rendered longest ago goes.
    const auto oldest = std::min_element(jobs_.begin(), jobs_.end(), [](auto& a, auto& b) {
      return a.second.units.back().ended_ms < b.second.units.back().ended_ms;
    });
    jobs_.erase(oldest);
  }
  void forget(uint64_t job) { jobs_.erase(job); }
  /// Empty where nothing is known.
  OfJob of(uint64_t job) const {
    const auto found = jobs_.find(job);
    return found == jobs_.end() ? OfJob{} : found->second;
  }

 private:
  static constexpr size_t kMostUnits = 20'000;
  static constexpr size_t kMostJobs = 32;
  std::map<uint64_t, OfJob> jobs_;
};

}  // namespace hyades::coordinator
