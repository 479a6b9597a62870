#include "worker/render/process_memory.h"

#include <malloc.h>
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

}  // namespace hyades::worker
