#pragma once

#include <memory>
#include <vector>

#include "core/base/distribution.h"
#include "core/lights/bilinear_cell.h"
#include "core/lights/light_picture.h"

namespace hyades::core {

/// The picture that a projector throws, looked up bilinearly, with what it takes to choose places
/// in proportion to luminance. Places are (u, v) in [0, 1]^2 from its top left corner; the
/// outermost half pixels keep their value up to the border. Immutable and thread-safe; takes 4
/// bytes per pixel on top of the image.
class Gobo {
 public:
  /// `image` as LightPicture takes it.
  explicit Gobo(std::shared_ptr<const Image> image);

  /// What is at a place.
  struct View {
    Rgb value{0.0F};
    float pdf = 0.0F;  ///< density per area of the unit square with which sample() chooses it
  };
  View view(const Vec2& place) const;

  /// A place for `u` in [0, 1)^2. Only where the picture is not all black.
  Vec2 sample(const Vec2& u) const;

  /// Half of its width and height where half the shorter side is 1.
  Vec2 half_size() const { return half_size_; }

  /// The mean of each cell of a grid of kOverview x kOverview over the picture, by rows.
  static constexpr int kOverview = 64;
  const std::vector<Rgb>& overview() const { return overview_; }

 private:
  /// A place in the grid of cells between pixel centres; the cells of the border are half as wide.
  struct Place {
    int column = 0;
    int row = 0;
    Vec2 within{0.0F};  ///< 0..1, right and down
  };
  Place locate(const Vec2& place) const;
  BilinearCell cell(int column, int row) const;
  void look_over();

  LightPicture picture_;
  Vec2 half_size_;
  Distribution2D cells_;
  std::vector<Rgb> overview_;
};

}  // namespace hyades::core
