#include "core/media/grid_fields.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/color.h"

namespace hyades::core {
namespace {

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

class GridColor final : public ColorField {
 public:
  GridColor(std::shared_ptr<const BrickGrid<Rgb>> grid, const Mat4& to_grid)
      : grid_(std::move(grid)), to_grid_(to_grid) {}

  Rgb at(const Vec3& p) const override { return grid_->at(transform_point(to_grid_, p)); }

 private:
  std::shared_ptr<const BrickGrid<Rgb>> grid_;
  Mat4 to_grid_;
};

/// Light of black bodies, tabulated.
class BlackBodies {
 public:
  BlackBodies() {
    for (int i = 0; i <= kSteps; ++i) {
      const float kelvin = kLowest + static_cast<float>(i) * kStep;
      const float relative = kelvin / 1500.0F;
      const float square = relative * relative;
      colors_.push_back(blackbody_color(kelvin) * (square * square));
    }
  }

  Rgb at(float kelvin) const {
    if (!(kelvin >= kLowest)) return Rgb(0.0F);
    const float place = std::min((kelvin - kLowest) / kStep, static_cast<float>(kSteps));
    const auto i = static_cast<size_t>(std::min(place, static_cast<float>(kSteps - 1)));
    return glm::mix(colors_[i], colors_[i + 1], place - static_cast<float>(i));
  }

 private:
  static constexpr float kLowest = 500.0F;
  static constexpr float kStep = 25.0F;
  static constexpr int kSteps = 780;  ///< to 20,000 K; what is hotter glows as that
  std::vector<Rgb> colors_;
};

class Glow final : public ColorField {
 public:
  explicit Glow(const GridGlow& glow) : glow_(glow) {}

  Rgb at(const Vec3& p) const override {
    Rgb light(1.0F);
    if (glow_.factor) light *= glow_.factor->at(transform_point(glow_.to_factor, p));
    if (glow_.temperature) {
      const Vec3 place = transform_point(glow_.to_temperature, p);
      light *= black_bodies_.at(glow_.kelvin * glow_.temperature->at(place));
    }
    return light;
  }

 private:
  GridGlow glow_;
  BlackBodies black_bodies_;
};

}  // namespace

std::shared_ptr<const DensityField> make_grid_density(
    std::shared_ptr<const BrickGrid<float>> grid) {
  return std::make_shared<GridDensity>(std::move(grid));
}

std::shared_ptr<const ColorField> make_grid_color(std::shared_ptr<const BrickGrid<Rgb>> grid,
                                                  const Mat4& to_grid) {
  return std::make_shared<GridColor>(std::move(grid), to_grid);
}

std::shared_ptr<const ColorField> make_grid_glow(const GridGlow& glow) {
  return std::make_shared<Glow>(glow);
}

}  // namespace hyades::core
