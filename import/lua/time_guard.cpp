#include "import/lua/time_guard.h"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "core/base/machine.h"

namespace hyades::core::lua {

TimeGuard::TimeGuard(double seconds, std::string slow, std::string what)
    : slow_(std::move(slow)), what_(std::move(what)) {
  ::pthread_getcpuclockid(::pthread_self(), &clock_);
  constexpr double kSlow = 10;
  slow_at_ = thread_seconds() + kSlow;
  end_ = thread_seconds() + seconds;
  thread_ = std::thread([this] { watch(); });
}

TimeGuard::~TimeGuard() {
  {
    const MutexLock lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void TimeGuard::watch() {
  const MutexLock lock(mutex_);
  while (!over_) {
    const double gone = processor_seconds(clock_);
    if (gone >= end_) {
      std::fprintf(stderr, "%s\n", what_.c_str());
      std::_Exit(2);
    }
    if (gone >= slow_at_ && !slow_.empty()) {
      std::fprintf(stderr, "%s\n", slow_.c_str());
      slow_.clear();
    }
    const double left = (slow_.empty() ? end_ : std::min(slow_at_, end_)) - gone;
    // Processor time takes at least as long.
    const auto wait = std::chrono::duration<double>(std::clamp(left, 0.05, 3600.0));
    wake_.wait_until(mutex_, std::chrono::steady_clock::now() +
                                 std::chrono::duration_cast<std::chrono::nanoseconds>(wait));
  }
}

}  // namespace hyades::core::lua
