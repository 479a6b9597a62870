#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace hyades::coordinator {

/// What has to be stored or tidied up in the background. Tasks of one owner (a job, say) are done
/// in the order in which they were added, one at a time; one that cannot be done now comes again
/// later, and those of other owners go on meanwhile. Thread-safe.
class RetryQueue {
 public:
  /// Whether it is done; false: try again after kAgain. Called without any lock.
  using Task = std::function<bool()>;
  static constexpr std::chrono::seconds kAgain{1};

  explicit RetryQueue(size_t threads);
  /// Ends as end() does.
  ~RetryQueue();
  RetryQueue(const RetryQueue&) = delete;
  RetryQueue& operator=(const RetryQueue&) = delete;

  /// Never waits.
  void add(uint64_t owner, Task task);
  /// Tries all that is left once more, without pauses, and ends; what cannot be done then is given
  /// up, with all that would have come after it. What is added afterwards is not done.
  void end();

 private:
  using Time = std::chrono::steady_clock::time_point;
  void work();
  void wake_due(Time now);

  std::mutex mutex_;
  std::condition_variable wake_;
  /// An owner with tasks is in exactly one place: ready, put off, or in some thread's hands.
  std::map<uint64_t, std::deque<Task>> background_;
  std::deque<uint64_t> ready_;
  std::multimap<Time, uint64_t> put_off_;
  size_t in_work_ = 0;
  bool end_ = false;
  bool ended_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace hyades::coordinator
