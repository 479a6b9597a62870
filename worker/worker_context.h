#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "farm/log.h"
#include "worker/event_loop.h"
#include "worker/state_machine.h"
#include "worker/worker.h"

namespace hyades::worker {

/// The worker's log. For the loop's thread.
class WorkerLog {
 public:
  explicit WorkerLog(std::string name) : name_(std::move(name)) {}

  /// The worker's name, as the coordinator has it.
  void rename(const std::string& name) { name_ = name; }

  void note(farm::LogLevel level, const std::string& text, farm::LogFields about = {}) const {
    // People know whose log they read; what collects those of many workers does not.
    if (farm::log_format() == farm::LogFormat::json) about.worker = name_;
    farm::log(level, text, about);
  }

 private:
  std::string name_;
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
