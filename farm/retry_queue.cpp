#include "farm/retry_queue.h"

#include <utility>

namespace hyades::farm {

RetryQueue::RetryQueue(size_t threads, std::chrono::nanoseconds pause, size_t of_one)
    : pause_(pause), of_one_(of_one) {
  for (size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

RetryQueue::~RetryQueue() { end(); }

void RetryQueue::add(uint64_t key, Task task, const std::string& owner) {
  const core::MutexLock lock(mutex_);
  if (ended_) return;
  const auto [queue, fresh] = tasks_.try_emplace(key);
  queue->second.left.push_back(std::move(task));
  if (!fresh) return;
  queue->second.owner = owner;
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

std::optional<uint64_t> RetryQueue::take_next(Time now) {
  // Clang does not see that the lock is held where it is called.
  const auto best =
      shares_.next(ready_.begin(), ready_.end(), now,
                   [&](uint64_t key) HYADES_NO_THREAD_SAFETY_ANALYSIS -> const std::string* {
                     const std::string& owner = tasks_.at(key).owner;
                     const auto his = in_work_of_.find(owner);
                     return his != in_work_of_.end() && his->second >= of_one_ ? nullptr : &owner;
                   });
  if (best == ready_.end()) return std::nullopt;
  const uint64_t next = *best;
  ready_.erase(best);
  return next;
}

void RetryQueue::work() {
  core::MutexLock lock(mutex_);
  for (;;) {
    const Time begun = std::chrono::steady_clock::now();
    wake_due(begun);
    const auto key = take_next(begun);
    if (!key) {
      // One that is in work may leave others.
      if (end_ && in_work_ == 0) return;
      if (put_off_.empty()) {
        wake_.wait(mutex_);
      } else {
        wake_.wait_until(mutex_, Time(put_off_.begin()->first));
      }
      continue;
    }
    const auto queue = tasks_.find(*key);
    std::deque<Task>& left = queue->second.left;
    const std::string owner = queue->second.owner;
    Task task = std::move(left.front());
    ++in_work_;
    if (!owner.empty()) ++in_work_of_[owner];
    lock.unlock();
    const bool done = task();
    if (done) task = nullptr;
    lock.lock();
    --in_work_;
    const Time now = std::chrono::steady_clock::now();
    if (!owner.empty()) {
      if (--in_work_of_[owner] == 0) in_work_of_.erase(owner);
      shares_.use(owner, std::chrono::duration<double>(now - begun).count(), now);
    }
    if (done) {
      left.pop_front();
    } else if (end_) {
      left.clear();
    } else {
      left.front() = std::move(task);
    }
    if (left.empty()) {
      tasks_.erase(queue);
    } else if (done) {
      ready_.push_back(*key);
    } else {
      put_off_.emplace(now + pause_, *key);
    }
    wake_.notify_all();
  }
}

}  // namespace hyades::farm
