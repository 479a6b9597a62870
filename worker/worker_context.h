#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

#include "core/base/text.h"
#include "farm/log.h"
#include "farm/token_bucket.h"
#include "farm/wire.h"
#include "worker/event_loop.h"
#include "worker/state_machine.h"
#include "worker/worker.h"

namespace hyades::worker {

/// The worker's log: lines of bounded length, and of those that tell of its work many at once but
/// few in the long run, so that what others can make a worker say (a coordinator, above all) fills
/// no disk. For the loop's thread.
class WorkerLog {
 public:
  static constexpr int kLinesAtOnce = 1000;
  static constexpr int kLinesPerSecond = 1;

  explicit WorkerLog(std::string name) : name_(std::move(name)) {}

  /// The worker's name, as the coordinator has it.
  void rename(const std::string& name) { name_ = name; }

  /// Writes a line, or counts it as left out, which the next one that is written tells.
  void note(farm::LogLevel level, const std::string& text, const farm::LogFields& about = {},
            TimePoint now = std::chrono::steady_clock::now()) {
    if (level == farm::LogLevel::info || level == farm::LogLevel::warning) {
      if (!lines_.take(now)) {
        ++left_out_;
        return;
      }
      if (const uint64_t lines = std::exchange(left_out_, 0); lines > 0) {
        write(farm::LogLevel::warning,
              "too much to tell: " + core::counted(lines, "line") + " left out", {});
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
  farm::TokenBucket lines_{kLinesAtOnce, kLinesPerSecond, std::chrono::steady_clock::now()};
  uint64_t left_out_ = 0;
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
