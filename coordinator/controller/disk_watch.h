#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

#include <grpcpp/support/status.h>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/film_store/disk_room.h"

namespace hyades::coordinator {

/// Room on the disk: what is refused and held back while there is little, and what makes more.
/// Thread-safe.
class DiskWatch {
 public:
  DiskWatch(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs)
      : context_(context), dispatcher_(dispatcher), jobs_(jobs), room_(context.options.disk) {}
  /// Looks at the disk from now on, several times a second, until end().
  void start();
  void end() { rounds_.end(); }

  /// Measures the disk, holds back what has to wait for room, and lets go on what has it. An error
  /// of the system changes nothing.
  void measure() HYADES_EXCLUDES(state_lock);
  /// Whether `bytes` more of this owner's may be stored, or (0) something new may begin: OK, or
  /// RESOURCE_EXHAUSTED with the reason. May wait for the disk.
  grpc::Status admit(uint64_t bytes, const std::string& owner = {}) HYADES_EXCLUDES(state_lock);
  /// Whether the disk may be why a frame could not be finished.
  bool is_short_for(const core::Film& film) HYADES_EXCLUDES(state_lock);
  /// Whether even what was begun has to wait.
  bool is_full() const { return full_; }
  DiskLevel level() const HYADES_REQUIRES(state_lock) { return room_.level(); }
  /// Why there is little room; empty where there is enough.
  std::string reason() const HYADES_REQUIRES(state_lock) { return room_.reason(); }

 private:
  void walk() HYADES_EXCLUDES(state_lock);
  void look() HYADES_EXCLUDES(state_lock);
  void sweep_partials() HYADES_EXCLUDES(state_lock);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  DiskRoom room_ HYADES_GUARDED_BY(state_lock);
  uint64_t free_ HYADES_GUARDED_BY(state_lock) = UINT64_MAX;  ///< bytes, when it was last measured
  /// Bytes of the folder, when it was last walked through, and of the disk at that time.
  uint64_t walked_used_ HYADES_GUARDED_BY(state_lock) = 0;
  uint64_t walked_free_ HYADES_GUARDED_BY(state_lock) = 0;
  TimePoint room_made_
      HYADES_GUARDED_BY(state_lock);  ///< when film stores were last asked for room
  std::atomic<bool> full_{false};
  TimePoint walk_again_;   ///< of look() alone
  TimePoint sweep_again_;  ///< of look() alone
  farm::RetryQueue rounds_{1, std::chrono::milliseconds(250)};
};

}  // namespace hyades::coordinator
