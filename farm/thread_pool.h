#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "core/base/mutex.h"

namespace hyades::farm {

/// A few threads that do, one thing after the other, what may wait for the disk, so that those who
/// hand it to them (gRPC's threads above all, of which there are few) never do. Thread-safe.
class ThreadPool {
 public:
  /// `threads`: at least 1. `most_waiting`: of things that nobody has begun with.
  ThreadPool(size_t threads, size_t most_waiting);
  /// Does all that was submitted, then ends.
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Has one of them call `what` soon. False, and `what` is never called, where as much waits as
  /// may. Never waits itself.
  [[nodiscard]] bool submit(std::function<void()> what) HYADES_EXCLUDES(mutex_);

 private:
  void work() HYADES_EXCLUDES(mutex_);

  const size_t most_waiting_;
  core::Mutex mutex_;
  core::CondVar wake_;
  std::deque<std::function<void()>> waiting_ HYADES_GUARDED_BY(mutex_);
  bool end_ HYADES_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace hyades::farm
