#pragma once

#include <memory>

#include "core/media/density_field.h"
#include "core/media/majorant_grid.h"

namespace hyades::core {

/// How a medium varies in the space of its field: what bodies filled with it share.
struct Volume {
  std::shared_ptr<const DensityField> density;
  std::shared_ptr<const MajorantGrid> majorants;  ///< of `density`
  std::shared_ptr<const ColorField> tint;         ///< of scattered light; null: white
  std::shared_ptr<const ColorField> glow;         ///< of emission; null: as dense as the medium
};

}  // namespace hyades::core
