#pragma once

#include <cstddef>
#include <functional>

#include "core/base/result.h"

namespace hyades::core {

/// How many threads this process may run at once (its CPU affinity), at least 1.
int hardware_threads();

/// Calls body(i) once for each i in [0, count), on up to `threads` threads of which the caller is
/// one (`threads` <= 0: hardware_threads()). Indices are handed out in increasing order, `grain` at
/// a time. Every thread flushes denormals (FpMode). An exception of `body` ends the loop early
/// (indices in flight are finished) and becomes the error: that of the lowest index that threw,
/// whatever the number of threads.
Status parallel_for(size_t count, int threads, const std::function<void(size_t)>& body,
                    size_t grain = 1);

}  // namespace hyades::core
