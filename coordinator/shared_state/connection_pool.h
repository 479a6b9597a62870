#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/sql/connection.h"
#include "coordinator/sql/postgres.h"
#include "core/base/mutex.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// A few connections to one database for many threads, each for one of them at a time. They are
/// made when they are needed; those that are lost are replaced. Thread-safe.
class ConnectionPool {
 private:
  struct Slot {
    std::unique_ptr<SqlConnection> connection;
    bool lost = false;  ///< of the thread that has it
  };

 public:
  using Lost = std::function<void(const std::string& why)>;
  /// Makes a connection, which calls `lost` from within a statement once it is of no use any more.
  using Open = std::function<core::Result<std::unique_ptr<SqlConnection>>(const Lost& lost)>;

  /// At most `most` at a time; who needs one waits for it no longer than `patience`.
  ConnectionPool(Open open, size_t most, std::chrono::milliseconds patience)
      : open_(std::move(open)), most_(most), patience_(patience) {}

  /// A connection in the hands of one thread, given back at the end.
  class Loan {
   public:
    Loan(ConnectionPool& pool, std::unique_ptr<Slot> slot) : pool_(&pool), slot_(std::move(slot)) {}
    Loan(Loan&&) = default;
    Loan& operator=(Loan&&) = delete;
    ~Loan() {
      if (slot_) pool_->give_back(std::move(slot_));
    }
    SqlConnection& operator*() const { return *slot_->connection; }
    /// Whether it is of no use any more.
    bool is_lost() const { return slot_->lost; }

   private:
    ConnectionPool* pool_;
    std::unique_ptr<Slot> slot_;
  };

  /// A connection. Whoever has one asks for no other before it is given back. An error where none
  /// can be made, or all are in use for too long.
  core::Result<Loan> take();

 private:
  void give_back(std::unique_ptr<Slot> slot);

  const Open open_;
  const size_t most_;
  const std::chrono::milliseconds patience_;
  core::Mutex mutex_;
  core::CondVar changed_;
  std::vector<std::unique_ptr<Slot>> idle_ HYADES_GUARDED_BY(mutex_);
  size_t open_now_ HYADES_GUARDED_BY(mutex_) = 0;  ///< with those that are idle, or being made
};

/// Connections to a PostgreSQL database. `options.on_lost` is called for all of them together,
/// once, and only where another coordinator leads: a connection that is lost is replaced.
ConnectionPool::Open postgres_connections(const PostgresOptions& options);

}  // namespace hyades::coordinator
