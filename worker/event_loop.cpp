#include "worker/event_loop.h"

#include <utility>

namespace hyades::worker {

void EventLoop::post(std::function<void()> event) {
  const core::MutexLock lock(mutex_);
  posted_.push_back(std::move(event));
  wake_.notify_one();
}

void EventLoop::run_posted(std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  std::deque<std::function<void()>> events;
  {
    const core::MutexLock lock(mutex_);
    while (posted_.empty() && std::chrono::steady_clock::now() < end) {
      wake_.wait_until(mutex_, end);
    }
    events.swap(posted_);
  }
  for (const auto& event : events) event();
}

}  // namespace hyades::worker
