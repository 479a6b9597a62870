#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/film/byte_planes.h"
#include "core/film/id_counts.h"

/// Ids as film_codec.h stores them: docs/film.md describes the format.
namespace hyades::core {

/// Memory that `entries` pairs of pixel and id take while they are read, at most, and their names.
constexpr uint64_t id_memory(uint64_t entries) { return 48 * entries + (uint64_t{16} << 20U); }

/// Appends what the pixels hold, and the names.
void append_ids(std::vector<std::byte>& out, const IdLayer& layer);

/// Reads what append_ids() wrote into an empty layer. Takes at most `left` bytes of memory, and
/// leaves there what it has not taken.
Status read_ids(ByteReader& in, IdLayer& layer, uint64_t& left);

}  // namespace hyades::core
