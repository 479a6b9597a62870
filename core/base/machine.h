#pragma once

#include <cstdint>
#include <string>

namespace hyades::core {

/// Bytes of memory that the machine has; 0 where that is not known.
uint64_t machine_memory();

/// Seconds of a processor's time that the calling thread has used.
double thread_seconds();

/// The folder of the running program, with a "/" at its end; its fellow programs lie beside it.
/// Empty where that is not known.
std::string program_folder();

}  // namespace hyades::core
