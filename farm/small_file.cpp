#include "farm/small_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "core/base/descriptor.h"
#include "core/base/io_reason.h"

namespace hyades::farm {
namespace {

constexpr size_t kMostBytes = size_t{4} << 20U;
constexpr size_t kPiece = size_t{16} << 10U;

core::Error unreadable(const std::string& path, int error) {
  return {path + (error == ENOENT ? ": there is no such file"
                                  : ": cannot be read: " + core::io_reason(error))};
}

}  // namespace

core::Result<std::string> read_small_file(const std::string& path) {
  const core::Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid()) return unreadable(path, errno);
  std::string bytes;
  for (size_t size = 0; size <= kMostBytes;) {
    bytes.resize(size + kPiece);
    const ssize_t got = ::read(file.get(), bytes.data() + size, kPiece);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return unreadable(path, errno);
    size += static_cast<size_t>(got);
    if (got > 0) continue;
    bytes.resize(size);
    return bytes;
  }
  return core::Error{path + ": has more than 4 MiB: not what is expected here"};
}

}  // namespace hyades::farm
