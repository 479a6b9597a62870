#pragma once

#include "core/base/result.h"

namespace hyades::worker {

/// Makes the system calls of which enter_sandbox() tells fail from now on, for all threads. Errors:
/// why the kernel does not.
core::Status restrict_calls();

}  // namespace hyades::worker
