#pragma once

#include <cstdint>

#include "core/base/result.h"

namespace hyades::core {

/// Which system calls a process needs that reads what strangers wrote.
enum class AllowedCalls : uint8_t {
  render,  ///< reads files, computes in threads, answers through a socket that is open
  finish,  ///< and makes, writes, renames and removes files
  encode,  ///< and starts programs, which have the same calls: for video encoders
};

/// From now on this process, its threads and all that they start may make the system calls of
/// `allowed` alone, for good; none lifts this list, which is of what is allowed, so that a call
/// that a later kernel brings is refused. Nothing of them
/// - makes a socket or a connection, or sends to an address;
/// - reaches another process: no signals (also not by what a file's owner is sent, F_SETOWN), no
///   memory, no priorities, no shared memory, no leases and locks of files;
/// - takes memory that RLIMIT_DATA does not count (render alone);
/// - changes owners, modes, times or attributes of files, mounts, namespaces or the system.
/// Refused calls fail with EPERM; clone3 and openat2, whose arguments a filter cannot see, with
/// ENOSYS, so that the C library takes clone and openat. What files may be opened is
/// restrict_files()' (landlock.h). For x86-64; needs no_new_privs. Errors: why the kernel does not.
Status allow_calls(AllowedCalls allowed);

}  // namespace hyades::core
