#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/media/brick_grid.h"

namespace hyades::core {

/// A grid of a .vdb file.
template <class T>
struct VdbGrid {
  BrickGrid<T> voxels;  ///< at integer points; voxels that are not active count as 0
  Mat4 to_file{1.0F};   ///< from there to the file's own space, in which its grids lie together
};

/// The most that a grid may take up in memory.
inline constexpr size_t kMostVdbBytes = size_t{8} << 30U;

/// The grid of numbers (float or double) called `name` of the file `bytes`: OpenVDB (format
/// versions 222 to 224), or NanoVDB, see read_nanovdb.h. Values below 0 count as 0. Read here and
/// not by OpenVDB, which believes whatever sizes a file states: damaged files made it write beyond
/// its memory. Errors: no such file format, no such grid (tells which there are), a grid of another
/// type or a level set, nothing active, values that are not finite, a perspective transform, a grid
/// larger than kMostVdbBytes.
Result<std::shared_ptr<const VdbGrid<float>>> read_vdb_numbers(const Bytes& bytes,
                                                               const std::string& name);

/// Reads grid `name` of vectors of three, linear Rec.709, as read_vdb_numbers() reads numbers.
Result<std::shared_ptr<const VdbGrid<Rgb>>> read_vdb_colors(const Bytes& bytes,
                                                            const std::string& name);

}  // namespace hyades::core
