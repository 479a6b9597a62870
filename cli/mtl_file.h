#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/base/vec.h"

namespace hyades::cli {

/// What of a material of an MTL file (Wavefront, "MTL material format", 1995) a mesh that is
/// rendered by itself shows.
struct MtlMaterial {
  std::optional<core::Rgb> diffuse;  ///< Kd, 0..1
  core::Rgb emission{0.0F};          ///< Ke
  float index = 1.5F;                ///< Ni
  bool clear = false;                ///< d below 1, or Tr above 0: light goes through
};

/// The materials of an MTL file, by name. Lines that say anything else are passed over; errors name
/// the line: numbers that are none.
core::Result<std::map<std::string, MtlMaterial>> parse_mtl(std::string_view text);

}  // namespace hyades::cli
