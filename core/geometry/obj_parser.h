#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"

namespace hyades::core {

/// A face corner: indices from 0 into the file's positions, UVs and normals; -1 where not given.
struct ObjCorner {
  int32_t v = -1;
  int32_t vt = -1;
  int32_t vn = -1;
};

/// From face `first` on, until the next of these, faces are of material `name`.
struct ObjMaterial {
  size_t first = 0;
  std::string name;
};

/// Of a vertex of which no colour is said.
inline constexpr Vec4 kNoColor{1.0F, 1.0F, 1.0F, -1.0F};

/// What an OBJ file (Wavefront, "Advanced Visualizer Manual", appendix B1) holds of polygons.
struct ObjData {
  std::vector<Vec3> positions;
  std::vector<Vec4> colors;  ///< of positions, linear, 0..1, or kNoColor; empty where none has one
  std::vector<Vec2> uvs;
  std::vector<Vec3> normals;
  std::vector<ObjCorner> corners;
  std::vector<uint32_t> sizes;         ///< corners of each face
  std::vector<ObjMaterial> materials;  ///< in order; may be none, or begin after face 0
  std::vector<std::string> libraries;  ///< what follows each mtllib
  uint64_t left_out = 0;  ///< points, lines, curves, surfaces and faces without an area
};

/// Parses the lines v, vt, vn, f, usemtl and mtllib, in parallel; other lines (groups) are
/// passed over; points, lines, curves and faces of one or two corners are counted. Indices are in
/// range, and there are fewer than 2^32 corners. A position may have a colour behind it, as MeshLab
/// and Blender write it: `v x y z r g b` or with an alpha, codes of sRGB from 0 to 1, or from 0 to
/// 255 where one of the file is above 1; one number alone is the weight of a curve and means
/// nothing. Errors name the line: that of the first one.
Result<ObjData> parse_obj(std::span<const char> bytes);

}  // namespace hyades::core
