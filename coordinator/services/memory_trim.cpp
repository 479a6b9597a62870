#include "coordinator/services/memory_trim.h"

#include <malloc.h>

#include <algorithm>

namespace hyades::coordinator {
namespace {

/// What is worth the trouble [bytes].
constexpr size_t kMuch = size_t{16} << 20U;

/// Where blocks are mapped one by one. A bound that is set does not grow by itself.
constexpr int kMapped = 256 << 10;

}  // namespace

void return_large_blocks() { ::mallopt(M_MMAP_THRESHOLD, kMapped); }

void MemoryTrim::look() {
  // What was given back still counts as free, until it is used again.
  const size_t free = ::mallinfo2().fordblks;
  free_ = std::min(free_, free);
  if (free < free_ + kMuch) return;
  ::malloc_trim(0);
  free_ = free;
}

}  // namespace hyades::coordinator
