#include "coordinator/brain/chores.h"

#include <utility>

namespace hyades::coordinator {

Chores::Chores(size_t threads) {
  for (size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

Chores::~Chores() { end(); }

void Chores::add(uint64_t owner, Chore chore) {
  const std::lock_guard lock(mutex_);
  if (ended_) return;
  const auto [queue, fresh] = chores_.try_emplace(owner);
  queue->second.push_back(std::move(chore));
  if (!fresh) return;
  ready_.push_back(owner);
  wake_.notify_one();
}

void Chores::end() {
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

void Chores::wake_due(Time now) {
  while (!put_off_.empty() && (end_ || put_off_.begin()->first <= now)) {
    ready_.push_back(put_off_.begin()->second);
    put_off_.erase(put_off_.begin());
  }
}

void Chores::work() {
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
    const auto queue = chores_.find(owner);
    Chore chore = std::move(queue->second.front());
    ++in_work_;
    lock.unlock();
    const bool done = chore();
    if (done) chore = nullptr;
    lock.lock();
    --in_work_;
    if (done) {
      queue->second.pop_front();
    } else if (end_) {
      queue->second.clear();
    } else {
      queue->second.front() = std::move(chore);
    }
    if (queue->second.empty()) {
      chores_.erase(queue);
    } else if (done) {
      ready_.push_back(owner);
    } else {
      put_off_.emplace(std::chrono::steady_clock::now() + kAgain, owner);
    }
    wake_.notify_all();
  }
}

}  // namespace hyades::coordinator
