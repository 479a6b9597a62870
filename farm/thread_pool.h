#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "core/base/mutex.h"

namespace hyades::farm {

/// A few threads that do, one thing after the other, what may wait for the disk, so that those who
/// hand it to them (gRPC's threads above all, of which there are few) never do. Those whom things
/// are done for take turns. Thread-safe.
class ThreadPool {
 public:
  /// `threads`: at least 1. `most_waiting`: of things that nobody has begun with. `most_of_one`:
  /// how many threads one owner with a name has at a time, where things may take long.
  ThreadPool(size_t threads, size_t most_waiting, size_t most_of_one = SIZE_MAX);
  /// Does all that was submitted, then ends.
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Has one of them call `what` soon, for `owner`. False, and `what` is never called, where as
  /// much waits as may, or half of that for an owner with a name. Never waits itself.
  [[nodiscard]] bool submit(std::function<void()> what, const std::string& owner = {})
      HYADES_EXCLUDES(mutex_);

 private:
  void work() HYADES_EXCLUDES(mutex_);
  /// The owner whose turn it is; none: nothing waits, or theirs have their share.
  std::deque<std::string>::iterator next_owner() HYADES_REQUIRES(mutex_);

  const size_t most_waiting_;
  const size_t most_of_one_;
  core::Mutex mutex_;
  core::CondVar wake_;
  size_t waiting_ HYADES_GUARDED_BY(mutex_) = 0;
  std::map<std::string, std::deque<std::function<void()>>> of_ HYADES_GUARDED_BY(mutex_);
  std::deque<std::string> turns_ HYADES_GUARDED_BY(mutex_);  ///< the owners for whom things wait
  std::map<std::string, size_t> in_work_ HYADES_GUARDED_BY(mutex_);  ///< of owners with a name
  bool end_ HYADES_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace hyades::farm
