#include "farm/retry_queue.h"

#include <utility>

namespace hyades::farm {

RetryQueue::RetryQueue(size_t threads, std::chrono::nanoseconds pause) : pause_(pause) {
  for (size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

RetryQueue::~RetryQueue() { end(); }

void RetryQueue::add(uint64_t key, Task task) {
  const core::MutexLock lock(mutex_);
  if (ended_) return;
  const auto [queue, fresh] = tasks_.try_emplace(key);
  queue->second.push_back(std::move(task));
  if (!fresh) return;
  ready_.push_back(key);
  wake_.notify_one();
}

void RetryQueue::end() {
  {
    const core::MutexLock lock(mutex_);
    end_ = true;
    wake_.notify_all();
  }
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  const core::MutexLock lock(mutex_);
  ended_ = true;
}

void RetryQueue::wake_due(Time now) {
  while (!put_off_.empty() && (end_ || put_off_.begin()->first <= now)) {
    ready_.push_back(put_off_.begin()->second);
    put_off_.erase(put_off_.begin());
  }
}

void RetryQueue::work() {
  core::MutexLock lock(mutex_);
  for (;;) {
    wake_due(std::chrono::steady_clock::now());
    if (ready_.empty()) {
      // One that is in work may leave others.
      if (end_ && in_work_ == 0) return;
      if (put_off_.empty()) {
        wake_.wait(mutex_);
      } else {
        wake_.wait_until(mutex_, Time(put_off_.begin()->first));
      }
      continue;
    }
    const uint64_t key = ready_.front();
    ready_.pop_front();
    const auto queue = tasks_.find(key);
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
      tasks_.erase(queue);
    } else if (done) {
      ready_.push_back(key);
    } else {
      put_off_.emplace(std::chrono::steady_clock::now() + pause_, key);
    }
    wake_.notify_all();
  }
}

}  // namespace hyades::farm
