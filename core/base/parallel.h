#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <thread>

#include "core/base/result.h"

namespace hyades::core {

/// How many threads this process may run at once: its processors (affinity), but no more than its
/// container's quota (cgroup v2). At least 1.
int hardware_threads();

/// Whole processors that the text of a cgroup's cpu.max allows ("150000 100000" -> 2); nothing
/// where it sets no limit ("max 100000") or is not understood.
std::optional<int> parse_cpu_quota(std::string_view cpu_max);

/// Calls body(i) once for each i in [0, count), on up to `threads` threads of which the caller is
/// one (`threads` <= 0: hardware_threads()). Indices are handed out in increasing order, `grain` at
/// a time. Every thread flushes denormals (FpMode). An exception of `body` ends the loop early
/// (indices in flight are finished) and becomes the error: that of the lowest index that threw,
/// whatever the number of threads.
Status parallel_for(size_t count, int threads, const std::function<void(size_t)>& body,
                    size_t grain = 1);

/// A thread that runs `body`. An error where the system gives no more of them.
Result<std::thread> start_thread(std::function<void()> body);

}  // namespace hyades::core
