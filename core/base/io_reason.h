#pragma once

#include <string>

namespace hyades::core {

/// What errno value `error` means for a file or folder, in words that fit behind "cannot write X:
/// ".
std::string io_reason(int error);

/// Why a file could not be locked, in words, by the errno of lock_file(): that another process has
/// the lock (EWOULDBLOCK), or as io_reason() has it.
std::string lock_reason(int error);

}  // namespace hyades::core
