#pragma once

#include <string>

#include "core/base/result.h"

namespace hyades::worker {

/// Lets the calling thread, and those that it starts, reach no files but those that
/// enter_sandbox() names. Errors: why the kernel does not.
core::Status restrict_files(const std::string& cache);

}  // namespace hyades::worker
