#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec.h"

namespace hyades::core {

/// A picture in an MTL file, and the options before its name that have a counterpart.
struct MtlMap {
  std::string file;       ///< as written, '\' made '/'
  Vec2 offset{0.0F};      ///< -o
  Vec2 scale{1.0F};       ///< -s
  float base = 0.0F;      ///< -mm base gain: base + gain * value
  float gain = 1.0F;      ///< see base
  float strength = 1.0F;  ///< -bm: of bumps and normals
  bool clamp = false;     ///< -clamp on
  bool blend = true;      ///< between its pixels; not where -blendu and -blendv are both off
  std::string channel;    ///< -imfchan: red | green | blue | alpha | luminance; empty: not said
  bool given() const { return !file.empty(); }
};

/// Reads what follows the key of a picture; `left_out` gets what has no counterpart, "-boost 2". An
/// option whose value changes nothing is none of those. Null, or what was expected.
const char* read_mtl_map(std::string_view rest, MtlMap& map, std::vector<std::string>& left_out);

}  // namespace hyades::core
