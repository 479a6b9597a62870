#pragma once

#include "core/import/pbrt/context.h"
#include "core/media/write_vdb.h"

namespace hyades::core::pbrt {

/// What a medium's grids are made of, and how its numbers go with them.
struct MediumGrids {
  std::vector<VdbBox> boxes;  ///< "density", and "tint", "glow", "temperature" where it has them
  Rgb glow{0.0F};             ///< the mean colour of what it gives off by itself (rgbgrid)
};

/// Of "uniformgrid", "rgbgrid" and "cloud". With `check_only` the boxes have names and no values.
/// Errors: what is wrong with the numbers, or too many of them.
Result<MediumGrids> medium_grids(Context& context, const NamedEntity& medium, bool check_only);

}  // namespace hyades::core::pbrt
