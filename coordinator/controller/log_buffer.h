#pragma once

#include <cstdint>
#include <vector>

#include "coordinator/controller/state_lock.h"
#include "coordinator/job_store/job_store.h"
#include "coordinator/scheduler/ids.h"

namespace hyades::coordinator {

/// Lines of a job's log that are not stored yet: as many as may wait, and how many more there were.
/// Not thread-safe.
class LogBuffer {
 public:
  /// A line that is too many is dropped and counted.
  void add(StoredLine line);
  bool empty() const { return lines_.empty(); }

  /// Whether somebody shall store the lines now, which they do not yet; from here on they do.
  bool begin_storing(TimePoint now);
  /// Takes all lines, and a last one that tells of those dropped.
  std::vector<StoredLine> take();
  /// What was taken is stored.
  void stored() { storing_ = false; }
  /// It could not be: it waits before all others, of which the oldest go where too many wait, and
  /// is not tried again before `again`.
  void not_stored(std::vector<StoredLine> taken, TimePoint again);

 private:
  std::vector<StoredLine> lines_;
  uint64_t dropped_ = 0;  ///< since lines were last taken
  bool storing_ = false;
  TimePoint again_;
};

}  // namespace hyades::coordinator
