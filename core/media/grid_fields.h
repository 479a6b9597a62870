#pragma once

#include <memory>

#include "core/media/density_field.h"
#include "core/media/read_vdb.h"

/// Fields that are read off grids of values.
namespace hyades::core {

/// A density whose space has the grid's points at its integers.
std::shared_ptr<const DensityField> make_grid_density(std::shared_ptr<const BrickGrid<float>> grid);

/// Colours of a grid; `to_grid` leads from the space of the field into the grid's.
std::shared_ptr<const ColorField> make_grid_color(std::shared_ptr<const BrickGrid<Rgb>> grid,
                                                  const Mat4& to_grid);

/// How bright something glows: numbers of one grid times the light of black bodies whose
/// temperatures are those of another. Either may be missing. `kelvin` is what a temperature of 1
/// stands for; colours have luminance (T / 1500 K)^4 (Stefan and Boltzmann), 0 below 500 K.
struct GridGlow {
  std::shared_ptr<const BrickGrid<float>> factor;
  Mat4 to_factor{1.0F};
  std::shared_ptr<const BrickGrid<float>> temperature;
  Mat4 to_temperature{1.0F};
  float kelvin = 1.0F;
};
std::shared_ptr<const ColorField> make_grid_glow(const GridGlow& glow);

}  // namespace hyades::core
