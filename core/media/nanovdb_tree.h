#pragma once

#include <cstddef>
#include <span>

#include "core/base/result.h"
#include "core/media/nanovdb_file.h"
#include "core/media/vdb_tree.h"

namespace hyades::core {

/// What stands before the tree in the bytes of a grid.
inline constexpr size_t kNanoGridBytes = 672;

/// The active voxels of a grid of NanoVDB, all of whose bytes are `grid`: T float for numbers of
/// any kind, Rgb for vectors. Every offset is checked against the bytes before it is followed, and
/// nodes that lie over one another are refused, so that time and memory are bounded by the
/// grid's size and `most_blocks`. Errors: those, values that are not finite.
template <class T>
Result<VdbTree<T>> read_nanovdb_tree(std::span<const std::byte> grid, NanoType type,
                                     size_t most_blocks);

}  // namespace hyades::core
