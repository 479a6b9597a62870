#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {

inline constexpr JobId kJob{1};
inline constexpr WorkerId kAnna{1};
inline constexpr WorkerId kBert{2};

inline Digest digest(uint8_t value) {
  Digest d{};
  d[0] = value;
  return d;
}

/// A scheduler with a clock, and what it said last. Scenes take no time where nothing else is said.
class SchedulerBench {
 public:
  explicit SchedulerBench(SchedulerOptions options = {}, Duration scene_time = {})
      : scheduler(with_scenes(options, scene_time)) {}

  std::vector<Action> tell(const Event& event) {
    said = scheduler.handle(event, now);
    EXPECT_EQ(scheduler.audit(), "");
    return said;
  }
  template <class T>
  std::vector<T> all() const {
    std::vector<T> found;
    for (const Action& a : said) {
      if (const T* t = std::get_if<T>(&a)) found.push_back(*t);
    }
    return found;
  }
  template <class T>
  T only() const {
    const std::vector<T> found = all<T>();
    EXPECT_EQ(found.size(), 1U);
    return found.empty() ? T{} : found.front();
  }

  void add(JobPlan plan, RestoredJob restored = {}, JobId job = kJob) {
    tell(JobAdded{job, std::move(plan), std::move(restored)});
  }
  void join(WorkerId worker, std::vector<UnitInHand> in_hand = {}) {
    tell(WorkerJoined{worker, 1, "class", std::move(in_hand)});
  }
  /// The worker joins by a credential that others may have.
  void join_by(const std::string& credential, WorkerId worker) {
    tell(WorkerJoined{worker, 1, "class", {}, {}, 0, credential});
  }
  /// Anna and Bert are there, and the job's frame 1 is open.
  void begin(JobPlan plan) {
    join(kAnna);
    join(kBert);
    add(std::move(plan));
    tell(FrameOpened{kJob, 1});
  }
  Lease ask(WorkerId worker, uint32_t units = 1) {
    tell(WorkRequested{worker, units});
    return only<Lease>();
  }
  /// Delivers a unit of the lease and says what followed.
  void deliver(const Lease& lease, size_t unit = 0, uint8_t bits = 1) {
    tell(ResultArrived{lease.worker, lease.lease, lease.job, lease.units.at(unit), digest(bits),
                       std::chrono::milliseconds(10)});
  }
  void deliver_durably(const Lease& lease, size_t unit = 0) {
    deliver(lease, unit);
    tell(Persisted{only<Persist>().id});
  }

  Scheduler scheduler;
  TimePoint now{};
  std::vector<Action> said;

 private:
  static SchedulerOptions with_scenes(SchedulerOptions options, Duration scene_time) {
    options.scene_time = scene_time;
    return options;
  }
};

inline JobPlan small_plan(std::vector<int32_t> frames = {1}, uint32_t batches = 2) {
  JobPlan plan;
  plan.frames = std::move(frames);
  plan.region = {0, 0, 64, 32};
  plan.tile_size = 32;
  plan.batches = batches;
  return plan;
}

}  // namespace hyades::coordinator
