#include "core/base/posix_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <thread>

namespace hyades::core {
namespace {

/// Has `read` read what is left and where that begins, until all is there or the file ends.
template <class Read>
std::optional<size_t> read_with(std::span<std::byte> into, Read read) {
  size_t done = 0;
  while (done < into.size()) {
    const ssize_t got = uninterrupted([&] { return read(into.subspan(done), done); });
    if (got < 0) return std::nullopt;
    if (got == 0) break;
    done += static_cast<size_t>(got);
  }
  return done;
}

template <class Write>
bool write_with(std::span<const std::byte> bytes, Write write) {
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t put = uninterrupted([&] { return write(bytes.subspan(done), done); });
    if (put == 0) errno = ENOSPC;
    if (put <= 0) return false;
    done += static_cast<size_t>(put);
  }
  return true;
}

}  // namespace

Descriptor open_file(const std::string& path, int flags, mode_t mode) {
  return Descriptor(uninterrupted([&] { return ::open(path.c_str(), flags | O_CLOEXEC, mode); }));
}

bool write_all(int file, std::span<const std::byte> bytes) {
  return write_with(bytes, [file](std::span<const std::byte> rest, size_t) {
    return ::write(file, rest.data(), rest.size());
  });
}

bool write_all_at(int file, std::span<const std::byte> bytes, uint64_t offset) {
  return write_with(bytes, [file, offset](std::span<const std::byte> rest, size_t done) {
    return ::pwrite(file, rest.data(), rest.size(), static_cast<off_t>(offset + done));
  });
}

std::optional<size_t> read_all(int file, std::span<std::byte> into) {
  return read_with(into, [file](std::span<std::byte> rest, size_t) {
    return ::read(file, rest.data(), rest.size());
  });
}

std::optional<size_t> read_all_at(int file, std::span<std::byte> into, uint64_t offset) {
  return read_with(into, [file, offset](std::span<std::byte> rest, size_t done) {
    return ::pread(file, rest.data(), rest.size(), static_cast<off_t>(offset + done));
  });
}

bool sync_folder(const std::string& folder) {
  const Descriptor handle = open_file(folder, O_RDONLY | O_DIRECTORY);
  if (!handle.valid()) return errno == EACCES;
  return ::fsync(handle.get()) == 0 || errno == EINVAL || errno == ENOTSUP;
}

bool lock_file(int file, int kind, std::chrono::milliseconds patience) {
  const auto until = std::chrono::steady_clock::now() + patience;
  for (std::chrono::milliseconds nap{1};; nap = std::min(2 * nap, std::chrono::milliseconds(50))) {
    if (uninterrupted([&] { return ::flock(file, kind | LOCK_NB); }) == 0) return true;
    if (errno != EWOULDBLOCK || std::chrono::steady_clock::now() >= until) return false;
    std::this_thread::sleep_for(nap);
  }
}

}  // namespace hyades::core
