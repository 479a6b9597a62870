#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdint>
#include <exception>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/fp_mode.h"
#include "core/base/mutex.h"

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

  Status status() const {
    const MutexLock lock(mutex_);
    return failed_ ? Status(Error{message_}) : Status();
  }

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
    const MutexLock lock(mutex_);
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
  mutable Mutex mutex_;
  bool failed_ HYADES_GUARDED_BY(mutex_) = false;
  size_t failed_index_ HYADES_GUARDED_BY(mutex_) = 0;
  std::string message_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace

std::optional<int> parse_cpu_quota(std::string_view cpu_max) {
  int64_t quota = 0;
  int64_t period = 0;
  const char* const end = cpu_max.data() + cpu_max.size();
  const auto first = std::from_chars(cpu_max.data(), end, quota);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != ' ') return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, period);
  if (second.ec != std::errc() || quota <= 0 || period <= 0) return std::nullopt;
  const int64_t whole = quota / period + (quota % period != 0 ? 1 : 0);
  return static_cast<int>(std::min<int64_t>(whole, 1 << 20));
}

int hardware_threads() {
  const int processors = static_cast<int>(std::thread::hardware_concurrency());
  // Inside a container this file is its own; outside it does not exist at the root.
  std::ifstream file("/sys/fs/cgroup/cpu.max");
  std::string line;
  std::getline(file, line);
  return std::max(1, std::min(processors, parse_cpu_quota(line).value_or(processors)));
}

Status parallel_for(size_t count, int threads, const std::function<void(size_t)>& body,
                    size_t grain) {
  grain = std::max<size_t>(grain, 1);
  const size_t wanted = static_cast<size_t>(threads > 0 ? threads : hardware_threads());
  const size_t useful = std::min(wanted, count / grain + (count % grain != 0 ? 1 : 0));
  Loop loop(count, grain, body);
  std::vector<std::thread> helpers;
  helpers.reserve(useful);
  for (size_t i = 1; i < useful; ++i) {
    auto helper = start_thread([&loop] { loop.run(); });
    if (!helper) break;  // those that are there do the work
    helpers.push_back(std::move(*helper));
  }
  loop.run();
  for (std::thread& helper : helpers) helper.join();
  return loop.status();
}

Result<std::thread> start_thread(std::function<void()> body) {
  try {
    return std::thread(std::move(body));
  } catch (const std::system_error& none) {
    return Error{"the system gives no more threads: " + none.code().message()};
  }
}

}  // namespace hyades::core
