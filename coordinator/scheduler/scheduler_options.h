#pragma once

#include <chrono>
#include <cstdint>

#include "coordinator/scheduler/ids.h"

namespace hyades::coordinator {

/// How the scheduler behaves towards every job.
struct SchedulerOptions {
  uint64_t incarnation = 1;  ///< greater after every restart
  /// A lease that is not renewed for this long is taken back.
  Duration lease_time = std::chrono::seconds(60);
  /// What rendering one unit shall take one thread: runs of batches are as long as that needs.
  Duration unit_time = std::chrono::milliseconds(500);
  /// Idle workers get a copy of a unit that has been out for this long, and sooner where it should
  /// have taken much less; 0: no copies.
  Duration copy_after = std::chrono::seconds(5);
  /// A frame whose class of workers has been gone for this long begins again with another; 0:
  /// never.
  Duration class_patience{0};
  /// A worker stays with scenes that it has loaded for this long though another job or frame is
  /// next in line; 0: never.
  Duration affinity_time = std::chrono::seconds(20);
  /// What loading a scene is taken to take until films have shown it; 0: it takes no time (all
  /// workers are threads of one machine), and never shows.
  Duration scene_time = std::chrono::seconds(3);
  /// So many units that a worker has failed one after the other and others then rendered put it
  /// into quarantine.
  uint32_t max_failures = 5;
  /// Bytes that films may take together; a frame begins (gets its first unit) when its own fits, or
  /// it is the only one. Where films cannot be set aside it is a quarter more.
  uint64_t film_memory = UINT64_MAX;
  /// Nothing is leased for this long after something could not be made durable.
  Duration storage_retry = std::chrono::seconds(1);
};

}  // namespace hyades::coordinator
