#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <optional>

#include "core/base/mutex.h"

namespace hyades::worker {

/// The one thread that everything happens in: other threads only post to it.
class EventLoop {
 public:
  /// To be run by the loop's thread, in the order of posting. From any thread.
  void post(std::function<void()> event) HYADES_EXCLUDES(mutex_);

  // All else is for the loop's thread.

  /// Runs what was posted; waits up to `patience` for it.
  void run_posted(std::chrono::milliseconds patience) HYADES_EXCLUDES(mutex_);

  /// The process ends soon, with this exit status.
  void end(int status) { status_ = status; }
  /// What end() was told.
  std::optional<int> ended() const { return status_; }

 private:
  core::Mutex mutex_;
  core::CondVar wake_;
  std::deque<std::function<void()>> posted_ HYADES_GUARDED_BY(mutex_);
  std::optional<int> status_;
};

}  // namespace hyades::worker
