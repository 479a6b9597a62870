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

bool ThreadPool::submit(std::function<void()> what, const std::string& owner) {
  const core::MutexLock lock(mutex_);
  if (waiting_ >= most_waiting_) return false;
  auto& his = of_[owner];
  if (!owner.empty() && his.size() >= (most_waiting_ + 1) / 2) return false;
  if (his.empty()) turns_.push_back(owner);
  his.push_back(std::move(what));
  ++waiting_;
  wake_.notify_one();
  return true;
}

void ThreadPool::work() {
  core::MutexLock lock(mutex_);
  for (;;) {
    while (!end_ && waiting_ == 0) wake_.wait(mutex_);
    if (waiting_ == 0) return;
    const auto his = of_.find(turns_.front());
    std::function<void()> what = std::move(his->second.front());
    his->second.pop_front();
    --waiting_;
    if (!his->second.empty()) turns_.push_back(turns_.front());
    turns_.pop_front();
    if (his->second.empty()) of_.erase(his);
    lock.unlock();
    what();
    what = nullptr;  // what it holds may take its time to go
    lock.lock();
  }
}

}  // namespace hyades::farm
