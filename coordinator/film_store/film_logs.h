#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/film_store/log_files.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// Where the film logs of jobs lie, each in a folder of its own. Thread-safe.
class FilmLogs {
 public:
  virtual ~FilmLogs() = default;

  /// The files of all logs.
  virtual LogFiles& files() = 0;
  /// Where the job's log lies among these.
  virtual std::string folder(uint64_t job) const = 0;
  /// Where its films go that leave memory: FilmStoreOptions::aside_folder.
  virtual std::string aside_folder(uint64_t job) const = 0;

  /// Whether the job has a log.
  virtual core::Result<bool> contains(uint64_t job) = 0;
  /// The jobs that have one, in any order.
  virtual core::Result<std::vector<uint64_t>> jobs() = 0;
  /// Removes at most `most` files of the job's log. Whether all have been gone through: what is
  /// left then cannot be removed now.
  virtual bool remove(uint64_t job, uint64_t most) = 0;
};

}  // namespace hyades::coordinator
