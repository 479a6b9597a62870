#pragma once

#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "coordinator/film_store/film_logs.h"
#include "coordinator/job_store/job_store.h"
#include "coordinator/shared_state/leader_lease.h"
#include "core/base/result.h"
#include "farm/channel.h"

namespace hyades::cli {

/// What is wrong with `text` as the database of coordinators, or nothing: a check for CLI11.
std::string database_error(const std::string& text);

/// How a coordinator takes part in a farm of several.
struct SharedFarmOptions {
  std::string database;                   ///< URL; empty: this coordinator is the farm's only one
  std::chrono::milliseconds lease{3000};  ///< LeaderOptions::time
  std::vector<farm::Listen> doors{};      ///< where a stand-by answers browsers and probes
  const sigset_t* signals = nullptr;      ///< blocked; each of them ends the waiting
};

/// A farm of several coordinators over one database, led by this process. Where it loses the lead
/// the process begins anew as a stand-by, with the same arguments: what it had in memory is of no
/// use, and the start is the one way by which a coordinator comes to know what is there.
class SharedFarm {
 public:
  /// Stands by until this process leads; null where a signal has come.
  static core::Result<std::unique_ptr<SharedFarm>> lead(const SharedFarmOptions& options);

  struct Stores {
    std::unique_ptr<coordinator::JobStore> jobs;
    std::unique_ptr<coordinator::FilmLogs> films;
  };
  /// What the database keeps. `scratch`: a folder of this machine's disk for what is temporary.
  core::Result<Stores> open_stores(const std::string& scratch);

  /// Whether it still leads.
  bool leads() const { return lease_->holds(); }
  /// Tells stand-bys where the leader's dashboard is. Where `url` is that of all addresses of this
  /// machine, its name is told.
  void set_url(const std::string& url);
  /// The lease is renewed while `works` says so; null: whatever happens.
  void lead_while(std::function<bool()> works);
  /// This process has been told to end: where it loses the lead now it does so at once.
  static void end_soon();

 private:
  explicit SharedFarm(std::string database, std::unique_ptr<coordinator::LeaderLease> lease);

  const std::string database_;
  const std::unique_ptr<coordinator::LeaderLease> lease_;
};

}  // namespace hyades::cli
