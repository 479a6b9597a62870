#pragma once

#include <array>
#include <vector>

#include "core/base/result.h"
#include "core/geometry/ply_header.h"

namespace hyades::core {

/// What a vertex property means: its place in a row of floats.
enum PlySlot : int {
  kX,
  kY,
  kZ,
  kNx,
  kNy,
  kNz,
  kU,
  kV,
  kSecondU,
  kSecondV,
  kRed,
  kGreen,
  kBlue,
  kAlpha,
  kTx,
  kTy,
  kTz,
  kTw,
  kPlySlots,
  kIgnored = -1
};

using PlyRow = std::array<float, kPlySlots>;

/// Which properties of the vertices a mesh takes.
struct PlyLayout {
  std::vector<PlySlot> slots;  ///< per property
  bool has_normals = false;
  bool has_uvs = false;
  bool has_second_uvs = false;
  bool has_colors = false;
  bool has_tangents = false;
  PlyRow defaults{};  ///< of what is not given: alpha and the tangents' side are 1
};

/// Error: the vertices lack a coordinate.
Result<PlyLayout> ply_layout(const PlyElement& vertices);

/// A colour's number as linear light: integers are sRGB codes of 0 to their type's largest value,
/// as painting programs write them, alpha a part of that; floats are linear already.
float ply_color(PlyType type, PlySlot slot, float value);

}  // namespace hyades::core
