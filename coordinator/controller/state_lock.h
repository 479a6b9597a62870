#pragma once

#include <chrono>

#include "core/base/mutex.h"

namespace hyades::coordinator {

/// Stands for the lock of the controller at hand: it guards the scheduler and all that the
/// controller's parts know of jobs and workers. Annotations name it, as Clang cannot see that the
/// parts of one controller share one mutex.
class HYADES_CAPABILITY("state lock") StateCapability {};
inline StateCapability state_lock;

/// The mutex behind state_lock; each controller has one.
class StateMutex {
 private:
  friend class StateLock;
  core::Mutex mutex_;
};

/// Holds the state lock for as long as it lives, except after unlock(). Nothing slow happens under
/// it.
class HYADES_SCOPED_CAPABILITY StateLock {
 public:
  explicit StateLock(StateMutex& mutex) HYADES_ACQUIRE(state_lock) HYADES_NO_THREAD_SAFETY_ANALYSIS
      : mutex_(mutex.mutex_) {
    mutex_.lock();
  }
  ~StateLock() HYADES_RELEASE() HYADES_NO_THREAD_SAFETY_ANALYSIS {
    if (held_) mutex_.unlock();
  }
  StateLock(const StateLock&) = delete;
  StateLock& operator=(const StateLock&) = delete;

  /// Lets go of the lock for good.
  void unlock() HYADES_RELEASE() HYADES_NO_THREAD_SAFETY_ANALYSIS {
    held_ = false;
    mutex_.unlock();
  }
  /// Lets go of the lock until `condition` is notified, or `time` has come.
  void wait_until(core::CondVar& condition, std::chrono::steady_clock::time_point time)
      HYADES_REQUIRES(state_lock) HYADES_NO_THREAD_SAFETY_ANALYSIS {
    condition.wait_until(mutex_, time);
  }

 private:
  core::Mutex& mutex_;
  bool held_ = true;
};

/// Stands for the state lock where a job is made ready that nobody else knows yet: nothing has to
/// be held for it, and what is slow may happen.
class HYADES_SCOPED_CAPABILITY NotSharedYet {
 public:
  NotSharedYet() HYADES_ACQUIRE(state_lock) HYADES_NO_THREAD_SAFETY_ANALYSIS {}
  ~NotSharedYet() HYADES_RELEASE() HYADES_NO_THREAD_SAFETY_ANALYSIS {}
  NotSharedYet(const NotSharedYet&) = delete;
  NotSharedYet& operator=(const NotSharedYet&) = delete;
};

}  // namespace hyades::coordinator
