#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/base/vec.h"

namespace hyades::core {

/// Numbers, or colours, at the points of a box, to be a grid of a .vdb file.
struct VdbBox {
  std::string name;           ///< "density"
  Vec3i lower{0};             ///< the first point
  Vec3i size{0};              ///< points along each axis
  Vec3d voxel{1.0};           ///< from one point to the next in the file's space
  Vec3d origin{0.0};          ///< where point 0, 0, 0 is in the file's space
  std::optional<Mat4> map;    ///< from points to the file's space, in place of these two
  std::vector<float> values;  ///< x runs fastest; 3 for each point where the grid is of colours
  bool colors = false;
};

/// The most points that a box may have along an axis.
inline constexpr int kMostVdbSide = 1 << 16;

/// A file of OpenVDB (format version 224, not compressed) that holds these grids as fog volumes:
/// read_vdb_numbers() and read_vdb_colors() read them from it, as OpenVDB does. Blocks of 8 x 8 x 8
/// of nothing but zeros are left out. Errors: boxes that are empty or too large, or whose values
/// are not as many as their points.
Result<Bytes> write_vdb(const std::vector<VdbBox>& boxes);

}  // namespace hyades::core
