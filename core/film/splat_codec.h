#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/film/byte_planes.h"
#include "core/film/splats.h"

/// Splats as film_codec.h stores them: docs/film.md describes the format.
namespace hyades::core {

/// Memory that `pixels` pixels with splats take while they are read, at most.
constexpr uint64_t splat_memory(uint64_t pixels) { return 320 * pixels; }

/// Appends what layer.count() pixels hold.
template <class Sums>
void append_splats(std::vector<std::byte>& out, const BasicSplatLayer<Sums>& layer);

/// Reads what append_splats() wrote of `count` pixels into an empty layer.
template <class Sums>
Status read_splats(ByteReader& in, uint32_t count, BasicSplatLayer<Sums>& layer);

}  // namespace hyades::core
