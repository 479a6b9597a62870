#include "coordinator/controller/retry_queue.h"

#include <utility>

namespace hyades::coordinator {

RetryQueue::RetryQueue(size_t threads) {
  for (size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

RetryQueue::~RetryQueue() { end(); }

void RetryQueue::add(uint64_t owner, Task task) {
  const std::lock_guard lock(mutex_);
  if (ended_) return;
  const auto [queue, fresh] = background_.try_emplace(owner);
  queue->second.push_back(std::move(task));
  if (!fresh) return;
  ready_.push_back(owner);
  wake_.notify_one();
}

void RetryQueue::end() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
    wake_.notify_all();
  }
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  const std::lock_guard lock(mutex_);
  ended_ = true;
}

void RetryQueue::wake_due(Time now) {
  while (!put_off_.empty() && (end_ || put_off_.begin()->first <= now)) {
    ready_.push_back(put_off_.begin()->second);
    put_off_.erase(put_off_.begin());
  }
}

void RetryQueue::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_due(std::chrono::steady_clock::now());
    if (ready_.empty()) {
      // One that is in work may leave others.
      if (end_ && in_work_ == 0) return;
      if (put_off_.empty()) {
        wake_.wait(lock);
      } else {
        wake_.wait_until(lock, Time(put_off_.begin()->first));
      }
      continue;
    }
    const uint64_t owner = ready_.front();
    ready_.pop_front();
    const auto queue = background_.find(owner);
    Task task = std::move(queue->second.front());
    ++in_work_;
    lock.unlock();
    const bool done = task();
    if (done) task = nullptr;
    lock.lock();
    --in_work_;
    if (done) {
      queue->second.pop_front();
    } else if (end_) {
      queue->second.clear();
    } else {
      queue->second.front() = std::move(task);
    }
    if (queue->second.empty()) {
      background_.erase(queue);
    } else if (done) {
      ready_.push_back(owner);
    } else {
      put_off_.emplace(std::chrono::steady_clock::now() + kAgain, owner);
    }
    wake_.notify_all();
  }
}

}  // namespace hyades::coordinator
