#include "core/base/machine.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <csignal>
#include <ctime>

#include "core/base/cgroup.h"

namespace hyades::core {

uint64_t usable_memory() {
  uint64_t least = UINT64_MAX;
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  const long size = ::sysconf(_SC_PAGESIZE);
  if (pages > 0 && size > 0) least = static_cast<uint64_t>(pages) * static_cast<uint64_t>(size);
  least = std::min(least, cgroup_memory_limit());
  rlimit own{};
  if (::getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY) {
    least = std::min<uint64_t>(least, own.rlim_cur);
  }
  return least == UINT64_MAX ? 0 : least;
}

uint64_t half_of_memory() {
  const uint64_t memory = usable_memory();
  return memory > 0 ? memory / 2 : UINT64_MAX;
}

void ignore_file_size_signal() { std::signal(SIGXFSZ, SIG_IGN); }

double thread_seconds() { return processor_seconds(CLOCK_THREAD_CPUTIME_ID); }

double processor_seconds(clockid_t clock) {
  timespec used{};
  ::clock_gettime(clock, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

std::string program_folder() {
  char path[PATH_MAX];
  const ssize_t length = ::readlink("/proc/self/exe", path, sizeof path - 1);
  if (length <= 0) return {};
  const std::string self(path, static_cast<size_t>(length));
  return self.substr(0, self.rfind('/') + 1);
}

}  // namespace hyades::core
