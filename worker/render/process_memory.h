#pragma once

#include <cstdint>

namespace hyades::worker {

/// Bytes of this process that are resident and belong to no file: what loading scenes costs.
uint64_t resident_memory();

/// Gives what was freed back to the system, so that resident_memory() tells the truth.
void trim_memory();

}  // namespace hyades::worker
