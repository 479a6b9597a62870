#pragma once

#include <cstdint>
#include <ctime>
#include <string>

namespace hyades::core {

/// Bytes of memory that this process may take: the least of what the machine has, the limits of its
/// control groups (cgroup_memory_limit()) and its own (ulimit -v). 0 where that is not known.
uint64_t usable_memory();

/// Half of that; all there can be where it is not known.
uint64_t half_of_memory();

/// From now on a file that may not grow further (ulimit -f) is an error of whoever writes it, as a
/// full disk is, and no signal that ends the process. Programs that are started inherit that.
void ignore_file_size_signal();

/// Seconds of a processor's time that the calling thread has used.
double thread_seconds();

/// Processor time of a thread, s, by its clock (pthread_getcpuclockid()).
double processor_seconds(clockid_t clock);

/// The folder of the running program, with a "/" at its end; its fellow programs lie beside it.
/// Empty where that is not known.
std::string program_folder();

}  // namespace hyades::core
