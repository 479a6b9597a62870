#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// Gives the bytes of a file piece by piece to `take` until it returns false. `size`: exactly so
/// many, and an error where there are fewer; nothing: as many as there are.
core::Status read_file(const std::string& path, std::optional<uint64_t> size,
                       const std::function<bool(std::span<const std::byte>)>& take);

}  // namespace hyades::coordinator
