#pragma once

#include <atomic>
#include <cstdint>
#include <map>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/state_lock.h"

namespace hyades::coordinator {

/// Tasks in work that somebody may break off, by their keys, of which no two are in work together.
class TasksInWork {
 public:
  explicit TasksInWork(ControllerContext& context) : context_(context) {}

  /// A task, in work as long as this is there.
  class Task {
   public:
    Task(TasksInWork& all, uint64_t key) HYADES_REQUIRES(state_lock) : all_(all), key_(key) {
      stop_ = &all_.stops_[key_];
      // Nobody breaks off what begins later.
      *stop_ = all_.context_.stop.load();
    }
    ~Task() {
      const StateLock lock(all_.context_.mutex);
      all_.stops_.erase(key_);
    }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

    /// Whether it is to end.
    const std::atomic<bool>& stop() const { return *stop_; }

   private:
    TasksInWork& all_;
    const uint64_t key_;
    std::atomic<bool>* stop_ = nullptr;
  };

  bool contains(uint64_t key) const HYADES_REQUIRES(state_lock) { return stops_.contains(key); }
  /// Breaks off the task, where it is in work.
  void break_off(uint64_t key) HYADES_REQUIRES(state_lock) {
    if (const auto one = stops_.find(key); one != stops_.end()) one->second = true;
  }
  void break_off_all() HYADES_REQUIRES(state_lock) {
    for (auto& [key, stop] : stops_) stop = true;
  }

 private:
  ControllerContext& context_;
  std::map<uint64_t, std::atomic<bool>> stops_ HYADES_GUARDED_BY(state_lock);
};

}  // namespace hyades::coordinator
