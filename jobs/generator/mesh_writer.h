#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/vec.h"

namespace hyades::gallery {

using core::Vec2;
using core::Vec3;

/// A mesh under construction.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< empty, or one per position
  std::vector<Vec2> uvs;      ///< empty, or one per position
  std::vector<std::array<uint32_t, 3>> triangles;
};

/// Writes binary little-endian PLY. False (and a message) where the file can't be written.
bool write_ply(const std::string& path, const Mesh& mesh, const std::string& comment);

}  // namespace hyades::gallery
