#pragma once

#include <algorithm>
#include <cstddef>

#include "core/base/parallel.h"

namespace hyades::core {

/// Elements that one thread handles at a time in loops over vertices and triangles.
inline constexpr size_t kChunk = size_t{1} << 15;

inline size_t chunk_count(size_t n) { return (n + kChunk - 1) / kChunk; }

/// body(begin, end) over the chunks of [0, n), in parallel where there are several.
template <class Body>
void for_chunks(size_t n, const Body& body) {
  (void)parallel_for(chunk_count(n), n > kChunk ? 0 : 1, [&](size_t chunk) {
    body(chunk * kChunk, std::min(n, (chunk + 1) * kChunk));
  });
}

}  // namespace hyades::core
