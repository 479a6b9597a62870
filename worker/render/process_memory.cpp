#include "worker/render/process_memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace hyades::worker {

uint64_t resident_memory() {
  std::ifstream file("/proc/self/statm");
  uint64_t size = 0;
  uint64_t resident = 0;
  uint64_t of_files = 0;
  file >> size >> resident >> of_files;
  return (resident - of_files) * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
}

void trim_memory() { ::malloc_trim(0); }

void limit_memory(uint64_t bytes) {
  std::ofstream("/proc/self/oom_score_adj") << 800;
  if (bytes == 0) return;
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace hyades::worker
