#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/film/film.h"

namespace hyades::core {

/// A film as compact bytes for the log and the wire: versioned, checksummed (CRC-32C), byte planes
/// that are zero left out, the rest zstd-compressed at its fastest level. A film of one batch takes
/// about 4 bytes per pixel and channel. docs/film.md describes it.
std::vector<std::byte> encode_film(const Film& film);

/// The inverse; refuses anything damaged, truncated or absurd with a reason, memory bounded.
Result<Film> decode_film(std::span<const std::byte> bytes);

}  // namespace hyades::core
