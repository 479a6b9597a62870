#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/film/film.h"
#include "core/film/unit.h"
#include "farm/wire.h"
#include "hyades/v1/work.pb.h"

namespace hyades::worker {

/// The least that a worker needs of a coordinator: one job, cut into units that anybody may have,
/// results that count once. For tests of the worker alone.
class FakeCoordinator {
 public:
  struct Job {
    std::map<std::string, std::string> files;  ///< by path; the document is "job.yaml"
    std::deque<core::Unit> units;
    core::Film film;  ///< to merge into
  };
  /// What has been seen so far.
  struct Seen {
    std::vector<v1::Hello> hellos;
    std::vector<v1::UnitFailure> failures;
    std::vector<v1::Leaving> leavings;
    std::vector<std::string> damage;  ///< what was wrong with results
    size_t accepted = 0;
    size_t shortened = 0;  ///< accepted results that are a part of their unit
    size_t doubles = 0;    ///< results that were there already
    size_t returned = 0;   ///< units given back
    size_t downloads = 0;
  };

  explicit FakeCoordinator(Job job);
  ~FakeCoordinator();

  uint32_t lease_ms = 10'000;
  uint32_t protocol = farm::kProtocol;
  size_t twins = 0;     ///< so many Hellos more are told that another process has their id
  bool silent = false;  ///< hears Hellos and says nothing
  bool acknowledge = true;
  std::string token;  ///< that workers have to show; empty: none. To be changed while it is stopped
  bool answer_failures = true;  ///< a failed unit is leased again

  /// "127.0.0.1:PORT"; the same port after a restart.
  std::string address() const;
  /// Breaks all streams off; start() goes on with the same books.
  void stop();
  void start();
  /// Whatever is leased may be leased again.
  void expire_leases();

  /// Waits until `reached` holds, at most for `limit`; returns whether it does.
  bool wait_until(const std::function<bool(const Seen&)>& reached,
                  std::chrono::seconds limit = std::chrono::seconds(60));
  bool wait_for_all();
  Seen seen() const;
  std::string film_digest() const;

 private:
  class WorkService;
  class AssetService;
  struct Books;
  std::unique_ptr<Books> books_;
};

}  // namespace hyades::worker
