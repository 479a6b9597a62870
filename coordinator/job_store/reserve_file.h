#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "core/base/mutex.h"

namespace hyades::coordinator {

/// Room on a disk that is kept for the day when there is no other: a file of zeros, removed when
/// something has to be written that makes room (the end of a job, say). Thread-safe.
class ReserveFile {
 public:
  static constexpr uint64_t kAmple = 4;  ///< times its size: what the disk must have free
  ReserveFile(std::string path, uint64_t bytes) : path_(std::move(path)), bytes_(bytes) {}

  /// Makes the file, if it is not there and the disk has kAmple times as much; cheap where it is.
  void keep();
  /// Removes it; whether that has made room.
  bool release();

 private:
  const std::string path_;
  const uint64_t bytes_;
  core::Mutex mutex_;
  bool kept_ HYADES_GUARDED_BY(mutex_) = false;
};

}  // namespace hyades::coordinator
