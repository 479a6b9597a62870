#pragma once

#include <string>

#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace hyades::worker {

/// What a worker is called by the coordinator: 32 random hexadecimal digits that stay the same when
/// it is started again, so that a quarantine holds. Kept in the cache folder, one file for each of
/// the workers that share it; a worker takes the first that no running one has. Where the folder
/// has come from another host (an image with a filled cache) the name is made anew.
class WorkerId {
 public:
  /// An error where the folder cannot be written.
  static core::Result<WorkerId> take(const std::string& cache_folder, const std::string& host);

  const std::string& text() const { return text_; }

 private:
  WorkerId(std::string text, core::Descriptor lock)
      : text_(std::move(text)), lock_(std::move(lock)) {}

  std::string text_;
  core::Descriptor lock_;  ///< of the file: released when the process ends, however that happens
};

}  // namespace hyades::worker
