#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <queue>
#include <thread>
#include <vector>

namespace hyades::bench {

/// Calls functions at their times, from a few threads.
class Timer {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Timer(int threads) {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
  }
  ~Timer() { stop(); }

  void at(Clock::time_point when, std::function<void()> what) {
    const std::lock_guard lock(mutex_);
    queue_.push({when, std::move(what)});
    changed_.notify_one();
  }

  /// Calls nothing more; returns when no call is under way.
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
      changed_.notify_all();
    }
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

 private:
  struct Item {
    Clock::time_point when;
    std::function<void()> what;
    bool operator<(const Item& other) const { return when > other.when; }
  };

  void run() {
    std::unique_lock lock(mutex_);
    while (!stopped_) {
      if (queue_.empty()) {
        changed_.wait(lock);
      } else if (const auto when = queue_.top().when; when > Clock::now()) {
        changed_.wait_until(lock, when);
      } else {
        const auto what = queue_.top().what;
        queue_.pop();
        lock.unlock();
        what();
        lock.lock();
      }
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::priority_queue<Item> queue_;
  std::vector<std::thread> threads_;
  bool stopped_ = false;
};

}  // namespace hyades::bench
