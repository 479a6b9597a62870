#include "farm/thread_pool.h"

#include <utility>

namespace hyades::farm {

ThreadPool::ThreadPool(size_t threads, size_t most_waiting) : most_waiting_(most_waiting) {
  for (size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

ThreadPool::~ThreadPool() {
  {
    const core::MutexLock lock(mutex_);
    end_ = true;
    wake_.notify_all();
  }
  for (std::thread& thread : threads_) thread.join();
}

bool ThreadPool::submit(std::function<void()> what) {
  const core::MutexLock lock(mutex_);
  if (waiting_.size() >= most_waiting_) return false;
  waiting_.push_back(std::move(what));
  wake_.notify_one();
  return true;
}

void ThreadPool::work() {
  core::MutexLock lock(mutex_);
  for (;;) {
    while (!end_ && waiting_.empty()) wake_.wait(mutex_);
    if (waiting_.empty()) return;
    std::function<void()> what = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    what();
    what = nullptr;  // what it holds may take its time to go
    lock.lock();
  }
}

}  // namespace hyades::farm
