#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/film/film.h"

namespace hyades::core {

/// What decode_film accepts, checked before memory is taken.
struct FilmLimits {
  uint64_t max_bytes = uint64_t{16}
                       << 30U;      ///< of the film in memory, and of what reading it takes
  uint32_t max_boxes = UINT32_MAX;  ///< of its coverage; that of a unit is one
};

/// A film as compact bytes for the log and the wire: versioned, checksummed (CRC-32C), byte planes
/// that are zero left out, the rest zstd-compressed at its fastest level. A film of one batch takes
/// about 4 bytes per pixel and channel. Equal films give equal bytes (with the same zstd library).
/// docs/film.md describes the format.
std::vector<std::byte> encode_film(const Film& film);

/// The film of bytes of encode_film(); refuses anything damaged, truncated or absurd with a reason.
/// Takes memory for at most 64 MiB + 4096 times the bytes given, and never more than the limits
/// say.
Result<Film> decode_film(std::span<const std::byte> bytes, const FilmLimits& limits = {});

/// What the film of bytes of encode_film() holds, by what stands at their beginning; they are not
/// looked at otherwise.
Result<Coverage> decode_coverage(std::span<const std::byte> bytes);

/// The most memory [bytes] that decode_film() takes for these, by what stands at their beginning;
/// where that is wrong they are refused before more is taken. UINT64_MAX where ids of objects or
/// materials follow: how many there are stands behind all else. Of bytes that are no film: 0.
uint64_t memory_to_decode(std::span<const std::byte> bytes);

}  // namespace hyades::core
