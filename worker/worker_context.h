#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include "core/base/text.h"
#include "farm/log.h"
#include "farm/wire.h"
#include "worker/event_loop.h"
#include "worker/state_machine.h"
#include "worker/worker.h"

namespace hyades::worker {

/// How many lines may be written: many at once, but few in the long run, so that what others can
/// make a worker say (a coordinator, above all) fills no disk.
class LogAllowance {
 public:
  static constexpr uint64_t kAtOnce = 1000;
  static constexpr Duration kOneMoreEvery = std::chrono::seconds(1);

  /// Whether one more may be written `now`; those that may not are counted.
  bool take(TimePoint now) {
    const auto more = static_cast<uint64_t>((now - counted_) / kOneMoreEvery);
    if (more > 0) counted_ = now;
    left_ = std::min(kAtOnce, left_ + more);
    if (left_ == 0) {
      ++withheld_;
      return false;
    }
    --left_;
    return true;
  }
  /// How many were not since the last call.
  uint64_t take_withheld() { return std::exchange(withheld_, 0); }

 private:
  uint64_t left_ = kAtOnce;
  uint64_t withheld_ = 0;
  TimePoint counted_;
};

/// The worker's log: lines of bounded length, and no more of those that tell of its work than
/// LogAllowance has it. For the loop's thread.
class WorkerLog {
 public:
  explicit WorkerLog(std::string name) : name_(std::move(name)) {}

  /// The worker's name, as the coordinator has it.
  void rename(const std::string& name) { name_ = name; }

  void note(farm::LogLevel level, const std::string& text, const farm::LogFields& about = {}) {
    if (level == farm::LogLevel::info || level == farm::LogLevel::warning) {
      if (!allowance_.take(std::chrono::steady_clock::now())) return;
      if (const uint64_t withheld = allowance_.take_withheld(); withheld > 0) {
        write(farm::LogLevel::warning,
              "too much to tell: " + core::counted(withheld, "line") + " left out", {});
      }
    }
    write(level, farm::wire_text(text), about);
  }

 private:
  void write(farm::LogLevel level, const std::string& text, farm::LogFields about) const {
    // People know whose log they read; what collects those of many workers does not.
    if (farm::log_format() == farm::LogFormat::json) about.worker = name_;
    farm::log(level, text, about);
  }

  std::string name_;
  LogAllowance allowance_;
};

/// What the parts of a worker share.
struct WorkerContext {
  const WorkerOptions& options;
  EventLoop& loop;
  WorkerLog& log;
  StateMachine& machine;
};

inline Duration in_seconds(double value) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(value));
}

}  // namespace hyades::worker
