#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "core/media/brick_grid.h"
#include "core/media/density_field.h"

/// Fields that are read off grids of values.
namespace hyades::core {

/// The grid's own points are the integer points of the field's space.
class GridDensity final : public DensityField {
 public:
  explicit GridDensity(std::shared_ptr<const BrickGrid<float>> grid) : grid_(std::move(grid)) {}

  float at(const Vec3& p) const override { return grid_->at(p); }

  Extent over(const Bounds& box) const override {
    Extent extent{3.0e38F, 0.0F};
    grid_->visit_values(box, [&](float v) {
      extent.least = std::min(extent.least, v);
      extent.greatest = std::max(extent.greatest, v);
    });
    return extent;
  }

  Bounds bounds() const override { return grid_->bounds(); }

 private:
  std::shared_ptr<const BrickGrid<float>> grid_;
};

}  // namespace hyades::core
