#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::worker {

/// How far a process that renders what strangers wrote is held (docs/safety.md).
enum class SandboxMode {
  automatic,  ///< as far as this machine can
  required,   ///< wholly, or not at all
  off,
};

/// "auto", "require", "off".
core::Result<SandboxMode> read_sandbox_mode(const std::string& word);

/// Gives up for good what rendering does not need, for this process and all threads that it starts
/// from now on; to be called before there are others. Afterwards it
/// - can gain no privileges (no_new_privs);
/// - reads programs, libraries and what the kernel tells (/usr, /lib, /proc, /sys), and the files
///   of `cache`; it opens no other file, writes and removes none (Landlock, since Linux 5.13; its
///   ABI 1 is enough), and signals nobody (ABI 6);
/// - makes only the system calls that rendering needs (core/sandbox/call_filter.h);
/// - sees no other files at all, where the machine allows user namespaces
///   (core/sandbox/private_root.h); nothing else depends on that, so that it is not required.
/// What is open stays open, so that the pipe to the worker does; everything from file descriptor
/// `first_closed` on is closed.
///
/// Returns what of this the machine lacks, in words; empty where it is complete. Where that is not
/// empty and `mode` is required, an error.
core::Result<std::string> enter_sandbox(SandboxMode mode, const std::string& cache,
                                        unsigned first_closed);

}  // namespace hyades::worker
