#pragma once

#include <cstdint>

#include "core/base/result.h"

namespace hyades::core {

// For processes that read what strangers wrote, before they give up writing files (landlock.h).

/// Should the machine run out of memory, this process is the first to go.
Status go_first();

/// From now on this process may have `bytes` of memory of its own, and stacks of 64 MiB; asking for
/// more fails (std::bad_alloc) instead of pushing the machine into swap. Memory that is shared and
/// files in memory are not counted. 0: no limit.
Status limit_memory(uint64_t bytes);

/// From now on no file that this process writes gets longer than `bytes`, also none that was open
/// before: whoever tries gets EFBIG where core::ignore_file_size_signal() was called.
Status limit_file_size(uint64_t bytes);

}  // namespace hyades::core
