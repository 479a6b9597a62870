#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/mutex.h"
#include "core/film/unit.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::coordinator {

/// Something that was done for a job: who did it, and when (v1::TimelineStep says what counts of
/// which kind).
struct TimedStep {
  v1::TimelineStep::Kind kind = v1::TimelineStep::KIND_UNSPECIFIED;
  std::string worker;  ///< its name; empty: the coordinator
  uint32_t thread = 0;
  core::Unit unit;
  int64_t begun_us = 0;  ///< since 1970, UTC
  int64_t ended_us = 0;
  uint64_t number = 0;  ///< given by Timelines
};

/// What was done where and when, for the jobs that last had something done: in memory only, for
/// those who look for what takes long. Thread-safe.
class Timelines {
 public:
  /// Adds a step of the job, and gives it its number.
  void note(uint64_t job, TimedStep step) HYADES_EXCLUDES(mutex_) {
    const core::MutexLock lock(mutex_);
    OfJob& timeline = jobs_[job];
    // Greater than any before, of an earlier run of the coordinator too.
    const auto now = static_cast<uint64_t>(std::max<int64_t>(step.ended_us, 1));
    step.number = timeline.steps.empty() ? now : std::max(now, timeline.steps.back().number + 1);
    timeline.steps.push_back(std::move(step));
    if (timeline.steps.size() > kMostSteps) {
      timeline.steps.pop_front();
      ++timeline.dropped;
    }
    if (jobs_.size() <= kMostJobs) return;
    // What was worked on longest ago goes.
    const auto oldest = std::min_element(jobs_.begin(), jobs_.end(), [](auto& a, auto& b) {
      return a.second.steps.back().number < b.second.steps.back().number;
    });
    jobs_.erase(oldest);
  }
  /// Drops the job's steps.
  void forget(uint64_t job) HYADES_EXCLUDES(mutex_) {
    const core::MutexLock lock(mutex_);
    jobs_.erase(job);
  }

  /// Some of a job's steps.
  struct Page {
    std::vector<TimedStep> steps;
    bool more = false;     ///< there are steps after these
    uint64_t dropped = 0;  ///< older ones that are not kept
  };
  /// Steps above number `after`, at most `limit`; none where nothing is known.
  Page page(uint64_t job, uint64_t after, size_t limit) const HYADES_EXCLUDES(mutex_) {
    const core::MutexLock lock(mutex_);
    const auto found = jobs_.find(job);
    if (found == jobs_.end()) return {};
    const auto& steps = found->second.steps;
    const auto first =
        std::upper_bound(steps.begin(), steps.end(), after,
                         [](uint64_t number, const TimedStep& s) { return number < s.number; });
    const auto left = static_cast<size_t>(steps.end() - first);
    const size_t count = std::min(limit, left);
    return {
        {first, first + static_cast<std::ptrdiff_t>(count)}, left > count, found->second.dropped};
  }

 private:
  struct OfJob {
    std::deque<TimedStep> steps;
    uint64_t dropped = 0;
  };
  static constexpr size_t kMostSteps = 40'000;
  static constexpr size_t kMostJobs = 32;
  mutable core::Mutex mutex_;
  std::map<uint64_t, OfJob> jobs_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace hyades::coordinator
