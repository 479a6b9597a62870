#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/base/distribution.h"
#include "core/base/vec.h"
#include "core/image/image.h"
#include "core/lights/bilinear_cell.h"
#include "core/lights/light_picture.h"

namespace hyades::core {

/// What directions towards a sky are chosen in proportion to. `excess`: to what its luminance has
/// above its mean over all directions, none where it has less: for estimators that find a sky by
/// their BSDFs too, which need the help where it is bright alone (MIS compensation; Karlik et al.
/// 2019, "MIS compensation: optimizing sampling techniques in multiple importance sampling").
enum class SkyDensity { luminance, excess };

/// A lat-long picture of the whole sphere of directions, looked up bilinearly, with what it takes
/// to choose directions by a SkyDensity. Direction (x, y, z), of any length but zero, is
/// at u = atan2(z, x) / 2pi + 0.5 from the left and v = acos(y) / pi from the top; columns wrap
/// around, the outermost half rows keep their value up to the poles. Negative values and NaN count
/// as black, at most 1e15 is seen. Immutable and thread-safe; takes 4 bytes per pixel on top of the
/// image.
///
/// Bilinear look-up is linear along both sides of each cell between four pixel centres. Directions
/// are chosen with a density bilinear in u and cos(theta) over the same cells, so the density per
/// solid angle follows the picture's luminance (up to the bend of cos(theta) within one row), and
/// is 0 only where all of a cell's corners that matter are black, or have no excess.
class EnvironmentMap {
 public:
  /// `image` has channels R, G, B or Y and at least one pixel.
  explicit EnvironmentMap(std::shared_ptr<const Image> image,
                          SkyDensity density = SkyDensity::luminance);

  /// What is seen in a direction.
  struct View {
    Rgb radiance{0.0F};
    float pdf = 0.0F;  ///< density per solid angle with which sample() chooses the direction
  };

  /// The view in `direction`; `turn` is added to u.
  View view(const Vec3& direction, float turn) const;

  /// Only the picture's value.
  Rgb look_up(const Vec3& direction, float turn) const;

  /// A direction for `u` in [0, 1)^2. Only where sampled() is not 0.
  Vec3 sample(const Vec2& u, float turn) const;

  /// The integral of the values over all directions, as sampling sees it [sr].
  Rgb integral() const { return integral_; }

  /// The integral over all directions of what they are chosen in proportion to [sr].
  float sampled() const { return sampled_; }

 private:
  /// A place in the grid of cells between pixel centres. Row 0 is the half row at the upper pole,
  /// row `height` the one at the lower.
  struct Place {
    int column = 0;
    int row = 0;
    float across = 0.0F;  ///< within the cell, 0..1, in u
    float down = 0.0F;    ///< in v, for look-up
    float lower = 0.0F;   ///< in cos(theta), for density
  };

  void measure(SkyDensity density);
  Rgb integrate() const;
  float excess(const Rgb& value) const;
  Place locate(const Vec3& direction, float turn) const;
  BilinearCell cell(int column, int row) const;
  BilinearCell sampled(const BilinearCell& cell) const;
  double cell_angle(int row) const;  ///< of each cell of a row [sr]

  LightPicture picture_;
  int width_;
  int height_;
  std::vector<double> cosines_;  ///< of theta at the rows' edges, from the upper pole down
  Distribution2D cells_;
  float floor_ = 0.0F;  ///< the luminance that is left out of the density
  Rgb integral_{0.0F};
  float sampled_ = 0.0F;
};

}  // namespace hyades::core
