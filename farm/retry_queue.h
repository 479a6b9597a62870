#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/mutex.h"
#include "farm/fair_shares.h"

namespace hyades::farm {

/// What has to be done in the background, by threads of its own. Tasks of one key (a job, say) are
/// done in the order in which they were added, one at a time; one that is not done comes again
/// after a pause, and those of other keys go on meanwhile. What goes on for ever is a task that is
/// never done. Tasks that have an owner take turns by owners: so many of each are done at a time,
/// and that is next whose owner has lately used the least time (FairShares). Thread-safe.
class RetryQueue {
 public:
  /// Whether it is done; false: it comes again after the queue's pause. Called without any lock.
  using Task = std::function<bool()>;

  /// `of_one`: how many tasks of one owner are done at a time, at least 1.
  explicit RetryQueue(size_t threads, std::chrono::nanoseconds pause = std::chrono::seconds(1),
                      size_t of_one = 1);
  /// Ends as end() does.
  ~RetryQueue();
  RetryQueue(const RetryQueue&) = delete;
  RetryQueue& operator=(const RetryQueue&) = delete;

  /// Never waits. All tasks of a key are of one owner.
  void add(uint64_t key, Task task, const std::string& owner = {}) HYADES_EXCLUDES(mutex_);
  /// Tries all that is left once more, without pauses, and ends; what is not done then is given up,
  /// with all that would have come after it. What is added afterwards is not done.
  void end() HYADES_EXCLUDES(mutex_);

 private:
  using Time = std::chrono::steady_clock::time_point;
  void work() HYADES_EXCLUDES(mutex_);
  void wake_due(Time now) HYADES_REQUIRES(mutex_);
  /// Takes the key whose turn it is out of those that are ready; none: their owners' are in work.
  std::optional<uint64_t> take_next(Time now) HYADES_REQUIRES(mutex_);

  const std::chrono::nanoseconds pause_;
  const size_t of_one_;
  core::Mutex mutex_;
  core::CondVar wake_;
  struct Tasks {
    std::string owner;
    std::deque<Task> left;
  };
  /// A key with tasks is in exactly one place: ready, put off, or in some thread's hands.
  std::map<uint64_t, Tasks> tasks_ HYADES_GUARDED_BY(mutex_);
  std::deque<uint64_t> ready_ HYADES_GUARDED_BY(mutex_);
  std::multimap<Time, uint64_t> put_off_ HYADES_GUARDED_BY(mutex_);
  size_t in_work_ HYADES_GUARDED_BY(mutex_) = 0;
  std::map<std::string, size_t> in_work_of_ HYADES_GUARDED_BY(mutex_);  ///< by owner
  FairShares shares_ HYADES_GUARDED_BY(mutex_);                         ///< seconds, of owners
  bool end_ HYADES_GUARDED_BY(mutex_) = false;
  bool ended_ HYADES_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace hyades::farm
