#include "farm/thread_pool.h"

#include <algorithm>
#include <utility>

namespace hyades::farm {

ThreadPool::ThreadPool(size_t threads, size_t most_waiting, size_t most_of_one)
    : most_waiting_(most_waiting), most_of_one_(most_of_one) {
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

std::deque<std::string>::iterator ThreadPool::next_owner() {
  return std::find_if(turns_.begin(), turns_.end(),
                      [this](const std::string& owner) HYADES_REQUIRES(mutex_) {
                        const auto his = in_work_.find(owner);
                        return his == in_work_.end() || his->second < most_of_one_;
                      });
}

void ThreadPool::work() {
  core::MutexLock lock(mutex_);
  for (;;) {
    const auto turn = next_owner();
    if (turn == turns_.end()) {
      if (end_ && waiting_ == 0) return;
      wake_.wait(mutex_);
      continue;
    }
    const std::string owner = std::move(*turn);
    turns_.erase(turn);
    const auto his = of_.find(owner);
    std::function<void()> what = std::move(his->second.front());
    his->second.pop_front();
    --waiting_;
    if (his->second.empty()) {
      of_.erase(his);
    } else {
      turns_.push_back(owner);
    }
    if (!owner.empty()) ++in_work_[owner];
    lock.unlock();
    what();
    what = nullptr;  // what it holds may take its time to go
    lock.lock();
    if (!owner.empty() && --in_work_[owner] == 0) in_work_.erase(owner);
    // Whoever waits for the end, or for the owner to have less than his share.
    wake_.notify_all();
  }
}

}  // namespace hyades::farm
