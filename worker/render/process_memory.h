#pragma once

#include <cstdint>

#include "core/base/result.h"

namespace hyades::worker {

/// Bytes of this process that are resident and belong to no file: what loading scenes costs.
uint64_t resident_memory();

/// Gives what was freed back to the system, so that resident_memory() tells the truth.
void trim_memory();

/// Should the machine run out of memory, this process is the first to go. Before enter_sandbox(),
/// which leaves nothing to be written.
core::Status go_first();

/// From now on this process may have `bytes` of memory of its own; asking for more fails
/// (std::bad_alloc) instead of pushing the machine into swap. Memory that this does not count is
/// what enter_sandbox() refuses. 0: no limit.
core::Status limit_memory(uint64_t bytes);

}  // namespace hyades::worker
