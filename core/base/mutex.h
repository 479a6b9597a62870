#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

// What lock guards what, said in code: Clang checks it (-Wthread-safety, tests/style/lint),
// and other compilers see nothing of it. It cannot follow two forms, which are told in prose:
// - a lock that keeps others from doing something meanwhile (one build of a scene, one submission
//   at a time) and guards no member. A std::unique_lock holds it, which is given from hand to hand;
// - a member of a struct that the lock of another object guards. Its comment names that lock.
#if defined(__clang__)
#define HYADES_THREAD_ANNOTATION(x) __attribute__((x))
#else
#define HYADES_THREAD_ANNOTATION(x)
#endif

/// Of a type: it is a lock, called so in diagnostics.
#define HYADES_CAPABILITY(name) HYADES_THREAD_ANNOTATION(capability(name))
/// Of a type: its constructor takes a lock, and its destructor lets it go.
#define HYADES_SCOPED_CAPABILITY HYADES_THREAD_ANNOTATION(scoped_lockable)
/// Of a member: it is read and written with this lock only.
#define HYADES_GUARDED_BY(lock) HYADES_THREAD_ANNOTATION(guarded_by(lock))
/// Of a function: who calls it has these locks.
#define HYADES_REQUIRES(...) HYADES_THREAD_ANNOTATION(requires_capability(__VA_ARGS__))
/// Of a function: who calls it has none of these locks, as it takes them itself, or is slow.
#define HYADES_EXCLUDES(...) HYADES_THREAD_ANNOTATION(locks_excluded(__VA_ARGS__))
/// Of a function: it takes these locks (none named: itself) and keeps them.
#define HYADES_ACQUIRE(...) HYADES_THREAD_ANNOTATION(acquire_capability(__VA_ARGS__))
/// Of a function: it lets go of these locks (none named: of itself).
#define HYADES_RELEASE(...) HYADES_THREAD_ANNOTATION(release_capability(__VA_ARGS__))

/// Of a function: who calls it has this lock, which is taken for granted and not proved.
#define HYADES_ASSERT_CAPABILITY(lock) HYADES_THREAD_ANNOTATION(assert_capability(lock))

/// Of a function: it is not looked into, as it does what the analysis cannot follow.
#define HYADES_NO_THREAD_SAFETY_ANALYSIS HYADES_THREAD_ANNOTATION(no_thread_safety_analysis)

namespace hyades::core {

/// A mutex that Clang's analysis knows.
class HYADES_CAPABILITY("mutex") Mutex {
 public:
  void lock() HYADES_ACQUIRE() { mutex_.lock(); }
  void unlock() HYADES_RELEASE() { mutex_.unlock(); }

 private:
  friend class CondVar;
  std::mutex mutex_;
};

/// Stands for a thread, for what that one alone reads and writes and no lock guards. It holds
/// nothing: a function that the thread enters by says so with assert_held().
class HYADES_CAPABILITY("role") ThreadRole {
 public:
  void assert_held() const HYADES_ASSERT_CAPABILITY(this) {}
};

/// Holds a mutex for as long as it lives, except between unlock() and lock().
class HYADES_SCOPED_CAPABILITY MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) HYADES_ACQUIRE(mutex) : mutex_(mutex) { mutex_.lock(); }
  ~MutexLock() HYADES_RELEASE() {
    if (held_) mutex_.unlock();
  }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

  void unlock() HYADES_RELEASE() {
    held_ = false;
    mutex_.unlock();
  }
  void lock() HYADES_ACQUIRE() {
    mutex_.lock();
    held_ = true;
  }

 private:
  Mutex& mutex_;
  bool held_ = true;
};

/// A condition that threads wait for with a Mutex held. It may wake without a reason: the caller
/// looks, in a loop, whether what he waits for has come.
class CondVar {
 public:
  void wait(Mutex& mutex) HYADES_REQUIRES(mutex) {
    std::unique_lock held(mutex.mutex_, std::adopt_lock);
    condition_.wait(held);
    held.release();
  }
  /// Waits until `time`, of any clock, at the latest.
  template <class Time>
  void wait_until(Mutex& mutex, const Time& time) HYADES_REQUIRES(mutex) {
    std::unique_lock held(mutex.mutex_, std::adopt_lock);
    condition_.wait_until(held, time);
    held.release();
  }
  void notify_one() { condition_.notify_one(); }
  void notify_all() { condition_.notify_all(); }

 private:
  std::condition_variable condition_;
};

}  // namespace hyades::core
