#pragma once

#include <memory>

#include "core/image/image.h"
#include "core/media/density_field.h"

namespace hyades::core {

/// An image of all directions (latitude-longitude, as an environment's) wrapped around the origin
/// between two radii.
struct Shell {
  std::shared_ptr<const Image> image;
  float inner = 0.8F;
  float outer = 1.0F;
  float turn = 0.0F;   ///< about +y, in whole turns
  float low = 0.0F;    ///< luminance at which the density is 0
  float high = 1.0F;   ///< and from which on it is 1
  float swirl = 0.0F;  ///< by which noise moves places before their direction is looked up, at most
  float scale = 4.0F;  ///< cells of that noise per length
  int octaves = 4;
  float time = 0.0F;
};

/// What a shell is made of.
struct ShellFields {
  /// clamp((Y - low) / (high - low), 0, 1) of the image's luminance Y in a direction, times
  /// 1 - (2 h - 1)^2 at height h, 0 at `inner` and 1 at `outer`.
  std::shared_ptr<const DensityField> density;
  /// The image's colour in a direction, relative to its brightest channel there.
  std::shared_ptr<const ColorField> tint;
  /// The image's colour in a direction, but of a luminance of `high` at most (a sun is not dense
  /// enough to be found), times the density's profile over the height.
  std::shared_ptr<const ColorField> glow;
};

/// The fields of `shell`, whose image has at least one pixel.
ShellFields make_shell(const Shell& shell);

}  // namespace hyades::core
