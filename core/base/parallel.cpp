#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "core/base/fp_mode.h"

namespace hyades::core {
namespace {

/// What the threads of one loop share.
class Loop {
 public:
  Loop(size_t count, size_t grain, const std::function<void(size_t)>& body)
      : count_(count), grain_(grain), body_(body) {}

  void run() {
    const FpMode mode;
    while (!stop_.load(std::memory_order_relaxed)) {
      const size_t begin = next_.fetch_add(grain_, std::memory_order_relaxed);
      if (begin >= count_) return;
      const size_t end = std::min(count_, begin + std::min(grain_, count_ - begin));
      for (size_t i = begin; i < end; ++i) {
        if (!try_one(i)) return;
      }
    }
  }

  Status status() const { return failed_ ? Status(Error{message_}) : Status(); }

 private:
  bool try_one(size_t i) {
    try {
      body_(i);
      return true;
    } catch (const std::exception& e) {
      fail(i, e.what());
    } catch (...) {
      fail(i, "unknown exception");
    }
    return false;
  }

  void fail(size_t i, const char* what) {
    stop_.store(true, std::memory_order_relaxed);
    const std::lock_guard lock(mutex_);
    if (failed_ && failed_index_ < i) return;
    failed_ = true;
    failed_index_ = i;
    message_ = what;
  }

  const size_t count_;
  const size_t grain_;
  const std::function<void(size_t)>& body_;
  std::atomic<size_t> next_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  bool failed_ = false;      // guarded by mutex_
  size_t failed_index_ = 0;  // guarded by mutex_
  std::string message_;      // guarded by mutex_
};

}  // namespace

int hardware_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Status parallel_for(size_t count, int threads, const std::function<void(size_t)>& body,
                    size_t grain) {
  grain = std::max<size_t>(grain, 1);
  const size_t wanted = static_cast<size_t>(threads > 0 ? threads : hardware_threads());
  const size_t useful = std::min(wanted, count / grain + (count % grain != 0 ? 1 : 0));
  Loop loop(count, grain, body);
  std::vector<std::thread> helpers;
  helpers.reserve(useful);
  try {
    for (size_t i = 1; i < useful; ++i) helpers.emplace_back([&loop] { loop.run(); });
  } catch (const std::system_error&) {
    // The system gives no more threads: those that are there do the work.
  }
  loop.run();
  for (std::thread& helper : helpers) helper.join();
  return loop.status();
}

}  // namespace hyades::core
