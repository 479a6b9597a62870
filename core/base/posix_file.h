#pragma once

#include <sys/types.h>

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/base/descriptor.h"

namespace hyades::core {

// Files as POSIX has them: calls that a signal interrupts go on, and reads and writes do all that
// is asked. Where something fails errno says why (io_reason.h has words for it).

/// Calls `call`, which tells of failure by a negative number and errno, again as long as signals
/// interrupt it.
template <class Call>
auto uninterrupted(Call call) {
  for (;;) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

/// Opens a file or folder, which programs that are started do not inherit; not valid where it
/// cannot be opened.
Descriptor open_file(const std::string& path, int flags, mode_t mode = 0666);

/// Writes all of `bytes`; false where that fails, also where the file takes no more (ENOSPC).
bool write_all(int file, std::span<const std::byte> bytes);
/// Writes all of `bytes` from this offset on, wherever the file stands; false where that fails.
bool write_all_at(int file, std::span<const std::byte> bytes, uint64_t offset);

/// Reads until `into` is full or the file ends: how many bytes; nothing where that fails.
std::optional<size_t> read_all(int file, std::span<std::byte> into);
/// Reads from this offset on, wherever the file stands, until `into` is full or the file ends.
std::optional<size_t> read_all_at(int file, std::span<std::byte> into, uint64_t offset);

/// Takes a lock of the open file (flock: LOCK_SH or LOCK_EX), for which it waits `patience` at
/// most: whoever may open a file may lock it, and need never let go. False, with EWOULDBLOCK, where
/// somebody else has it all that time.
bool lock_file(int file, int kind, std::chrono::milliseconds patience);

/// Names that were made, renamed or removed in the folder outlast a loss of power; false where that
/// fails. A folder that one may write to but not list cannot be synced by us, and some network file
/// systems keep names on their own and say EINVAL or ENOTSUP: both are no failures.
bool sync_folder(const std::string& folder);

}  // namespace hyades::core
