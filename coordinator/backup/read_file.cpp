#include "coordinator/backup/read_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/io_reason.h"
#include "core/base/posix_file.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kPiece = size_t{1} << 18U;

}  // namespace

core::Status read_file(const std::string& path, std::optional<uint64_t> size,
                       const std::function<bool(std::span<const std::byte>)>& take) {
  const core::Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  if (!file.valid()) return core::Error{path + ": " + core::io_reason(errno)};
  std::vector<std::byte> piece(kPiece);
  uint64_t left = size.value_or(UINT64_MAX);
  while (left > 0) {
    const auto got = core::read_all(
        file.get(), std::span(piece).first(static_cast<size_t>(std::min<uint64_t>(left, kPiece))));
    if (!got) return core::Error{path + ": " + core::io_reason(errno)};
    if (*got == 0) break;
    left -= *got;
    if (!take(std::span(piece).first(*got))) return {};
  }
  if (size && left > 0) return core::Error{path + ": it became shorter while it was read"};
  return {};
}

}  // namespace hyades::coordinator
