#include "import/lua/time_guard.h"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "core/base/machine.h"

namespace hyades::core::lua {

TimeGuard::TimeGuard(double seconds, std::string what) : what_(std::move(what)) {
  ::pthread_getcpuclockid(::pthread_self(), &clock_);
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
    const double left = end_ - processor_seconds(clock_);
    if (left <= 0.0) {
      std::fprintf(stderr, "%s\n", what_.c_str());
      std::_Exit(2);
    }
    // Processor time takes at least as long.
    const auto wait = std::chrono::duration<double>(std::clamp(left, 0.05, 3600.0));
    wake_.wait_until(mutex_, std::chrono::steady_clock::now() +
                                 std::chrono::duration_cast<std::chrono::nanoseconds>(wait));
  }
}

}  // namespace hyades::core::lua
