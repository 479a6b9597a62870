#include "coordinator/shared_state/connection_pool.h"

#include <atomic>

#include <fmt/format.h>

namespace hyades::coordinator {

core::Result<ConnectionPool::Loan> ConnectionPool::take() {
  const auto end = std::chrono::steady_clock::now() + patience_;
  core::MutexLock lock(mutex_);
  while (idle_.empty() && open_now_ >= most_) {
    if (std::chrono::steady_clock::now() >= end) {
      return core::Error{fmt::format("all {} connections to the database are in use", most_)};
    }
    changed_.wait_until(mutex_, end);
  }
  if (!idle_.empty()) {
    auto slot = std::move(idle_.back());
    idle_.pop_back();
    return Loan(*this, std::move(slot));
  }
  ++open_now_;
  lock.unlock();
  auto slot = std::make_unique<Slot>();
  auto opened = open_([slot = slot.get()](const std::string&) { slot->lost = true; });
  if (opened) {
    slot->connection = std::move(*opened);
    return Loan(*this, std::move(slot));
  }
  lock.lock();
  --open_now_;
  changed_.notify_one();
  return opened.error();
}

void ConnectionPool::give_back(std::unique_ptr<Slot> slot) {
  std::vector<std::unique_ptr<Slot>> gone;  // ended without the lock
  {
    const core::MutexLock lock(mutex_);
    if (slot->lost) {
      // Those that lie idle have most likely gone with it, each of which would fail a call.
      gone.swap(idle_);
      gone.push_back(std::move(slot));
      open_now_ -= gone.size();
    } else {
      idle_.push_back(std::move(slot));
    }
    changed_.notify_all();
  }
}

ConnectionPool::Open postgres_connections(const PostgresOptions& options) {
  return [options, told = std::make_shared<std::atomic<bool>>(false)](
             const ConnectionPool::Lost& lost) -> core::Result<std::unique_ptr<SqlConnection>> {
    PostgresOptions one = options;
    one.on_lost = [lost, told, tell = options.on_lost](const std::string& why) {
      lost(why);
      if (why == kOtherLeads && tell && !told->exchange(true)) tell(why);
    };
    return open_postgres(one);
  };
}

}  // namespace hyades::coordinator
