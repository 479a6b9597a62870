#pragma once

#include <cstddef>

namespace hyades::coordinator {

/// Gives memory back to the system that the allocator keeps after many have been served at once: it
/// may be gigabytes, and would be there for good. Not thread-safe.
class MemoryTrim {
 public:
  /// Looks whether something has become free, and gives it back: some milliseconds.
  void look();

 private:
  size_t free_ = 0;  ///< bytes that were free when memory was last given back, or fewer since
};

}  // namespace hyades::coordinator
