#pragma once

#include <cstddef>

namespace hyades::coordinator {

/// From now on blocks of 256 KiB and more go back to the system as soon as they are free, whatever
/// thread had them. The allocator would keep up to 32 MiB of each, in as many pools as there are
/// threads: films that have left would take as much memory as those that are there.
void return_large_blocks();

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
