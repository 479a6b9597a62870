#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace hyades::cli {

/// A new folder in TMPDIR that goes with this object, or with the process, however that ends: a
/// child waits for it. To be made before the process has other threads.
class TemporaryFolder {
 public:
  /// Called `prefix` and six letters. An error where TMPDIR names no folder that may be written to.
  static core::Result<std::unique_ptr<TemporaryFolder>> make(const std::string& prefix);
  /// Waits until the folder is gone.
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  TemporaryFolder(std::string path, core::Descriptor alive, pid_t remover);

  const std::string path_;
  core::Descriptor alive_;  ///< is closed when this goes, or the process
  const pid_t remover_;
};

}  // namespace hyades::cli
