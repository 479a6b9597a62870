#pragma once

#include <ctime>
#include <string>
#include <thread>

#include "core/base/mutex.h"

namespace hyades::core::lua {

/// Ends the process (status 2) where the thread that made this takes more processor time than it
/// may: one instruction of Lua may take hours (a table whose keys all collide), and nothing can
/// interrupt it. Says once that it takes long, before.
class TimeGuard {
 public:
  /// `seconds`: from now on. `what`: the line that is printed then; `slow`: the one after ten
  /// seconds.
  TimeGuard(double seconds, std::string slow, std::string what);
  ~TimeGuard();
  TimeGuard(const TimeGuard&) = delete;
  TimeGuard& operator=(const TimeGuard&) = delete;

 private:
  void watch();

  clockid_t clock_{};
  double slow_at_ = 0.0;  ///< of the watched thread's processor time [s]
  double end_ = 0.0;      ///< of that
  std::string slow_;      ///< empty: it has been said
  std::string what_;
  Mutex mutex_;
  CondVar wake_;
  bool over_ HYADES_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace hyades::core::lua
