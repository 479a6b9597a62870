#pragma once

#include <cstdint>

namespace hyades::worker {

/// Why a worker has not the files of a job, which decides whose units wait for it.
enum class FilesTrouble : uint8_t {
  hopeless,  ///< it will never have them: the job's units have failed
  job,       ///< what this job needs is not to be had now: it alone waits
  machine,   ///< this machine takes no file: whatever needs files waits
};

}  // namespace hyades::worker
