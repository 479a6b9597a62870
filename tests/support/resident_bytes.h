#pragma once

#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace hyades::test {

/// Bytes of memory that this process takes now.
inline uint64_t resident_bytes() {
  uint64_t pages = 0;
  std::ifstream statm("/proc/self/statm");
  statm >> pages >> pages;
  return pages * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace hyades::test
