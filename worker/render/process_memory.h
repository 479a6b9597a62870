#pragma once

#include <cstdint>

namespace hyades::worker {

/// Bytes of this process that are resident and belong to no file: what loading scenes costs.
uint64_t resident_memory();

/// Gives what was freed back to the system, so that resident_memory() tells the truth.
void trim_memory();

/// From now on this process may have `bytes` of memory of its own; asking for more fails
/// (std::bad_alloc) instead of pushing the machine into swap. Should the machine run out of memory
/// all the same, this process is the first to go. 0: no limit.
void limit_memory(uint64_t bytes);

}  // namespace hyades::worker
