#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "coordinator/shared_state/leader_watch.h"
#include "coordinator/sql/postgres.h"
#include "core/base/mutex.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// How a coordinator comes to lead.
struct LeaderOptions {
  std::string database;  ///< URL, see PostgresOptions
  std::string holder;    ///< this process, for people: HOST:PID
  /// Without a renewal for so long the others take over. The leader stops itself after four fifths
  /// of it.
  std::chrono::milliseconds time{3000};
  /// Waits for the database from the beginning; else it is an error where that cannot be reached.
  bool patient = false;
  /// Called once, by any thread: this process does not lead any more, or cannot know that it does.
  std::function<void(const std::string& why)> on_lost;
  /// Waits a moment; false where this process is to end.
  std::function<bool(std::chrono::milliseconds)> pause;
  /// Called by a stand-by when there is another leader, or another trouble (else empty).
  std::function<void(const LeaseRow& leader, const std::string& trouble)> tell;
};

/// How the leader with this incarnation connects: for PostgresOptions::on_lost see there.
PostgresOptions leader_connection(const std::string& database, uint64_t incarnation,
                                  std::function<void(const std::string& why)> on_lost);

/// That this process leads the coordinators of one database. One at a time does: whoever takes over
/// raises the incarnation, in which every write of the leader's is conditional (PostgresOptions),
/// so that one that was frozen, or cut off, can write nothing when it comes back. The lease says
/// when to try that; who may write never depends on a clock.
///
/// Renewals are not made durable: one that is lost counts as late.
class LeaderLease {
 public:
  /// Stands by until this process leads; null where `options.pause` has ended that. Makes the
  /// tables where there are none, and brings them to the newest schema once it leads. An error
  /// where they were written by a newer Hyades, or (unless patient) where the database cannot be
  /// reached.
  static core::Result<std::unique_ptr<LeaderLease>> wait(const LeaderOptions& options);

  /// Steps down, so that another takes over at once; unless the lease is lost.
  ~LeaderLease();
  LeaderLease(const LeaderLease&) = delete;
  LeaderLease& operator=(const LeaderLease&) = delete;

  /// The number of this leadership: greater than that of any before.
  uint64_t incarnation() const { return incarnation_; }
  /// What stand-bys tell people of: the dashboard's URL.
  void set_url(const std::string& url);
  /// The lease is renewed while `works` says that this process does what it is for; null: whatever
  /// happens. Once this returns what was given before is not called any more.
  void renew_while(std::function<bool()> works);
  /// Whether the lease still runs. What no database guards (files) is left alone where it does not.
  bool holds() const;

 private:
  using TimePoint = LeaderWatch::TimePoint;

  LeaderLease(LeaderOptions options, uint64_t incarnation, TimePoint begun);
  void renew();
  void watch();
  TimePoint end() const HYADES_REQUIRES(mutex_);
  void lose(const std::string& why);

  const LeaderOptions options_;
  const uint64_t incarnation_;
  mutable core::Mutex mutex_;
  core::CondVar wake_;
  TimePoint renewed_ HYADES_GUARDED_BY(mutex_);  ///< when the last renewal began
  std::string url_ HYADES_GUARDED_BY(mutex_);
  std::function<bool()> works_ HYADES_GUARDED_BY(mutex_);
  std::string trouble_ HYADES_GUARDED_BY(mutex_);  ///< of the database
  bool ends_ HYADES_GUARDED_BY(mutex_) = false;
  bool lost_ HYADES_GUARDED_BY(mutex_) = false;
  std::thread renewals_;
  std::thread watch_;  ///< a thread of its own: renewals may hang
};

}  // namespace hyades::coordinator
