#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/media/write_vdb.h"
#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// What a medium's grids are made of, and how its numbers go with them.
struct MediumGrids {
  std::vector<VdbBox> boxes;  ///< "density", and "tint", "glow", "temperature" where it has them
  std::string file{};         ///< the one that has them; empty: that which is made of `boxes`
  std::string grid{};         ///< of `file`: the densities
  Rgb glow{0.0F};             ///< the mean colour of what it gives off by itself (rgbgrid)
};

/// The most points of a box that is made here.
inline constexpr uint64_t kMostVoxels = uint64_t{1} << 28;

/// Of "uniformgrid", "rgbgrid" and "cloud", and of a "nanovdb" that glows. With `check_only` the
/// boxes have names and no values. Errors: what is wrong with the numbers, or too many of them.
Result<MediumGrids> medium_grids(Context& context, const NamedEntity& medium, bool check_only);

}  // namespace hyades::core::pbrt
