#pragma once

#include <optional>
#include <string>

#include "core/job/animated.h"
#include "core/job/transform_desc.h"

namespace hyades::core {

/// A density made of noise, within the bounds of the body that it fills.
struct NoiseDensityDesc {
  Animated<Vec3> scale{Vec3(1.0F)};  ///< cells per length
  Animated<Vec3> offset{Vec3(0.0F)};
  int octaves = 5;
  Animated<float> lacunarity{2.0F};
  Animated<float> gain{0.5F};
  Animated<float> time{0.0F};  ///< the fourth coordinate
  Animated<float> low{0.5F};   ///< noise, 0 to 1, at which the density is 0
  Animated<float> high{0.7F};  ///< and from which on it is 1
  Animated<float> fade{0.0F};  ///< share of the way to the middle on which it thins out
};

/// An image of all directions, wrapped around the body's origin, whose bright parts are dense.
struct ShellDensityDesc {
  std::string image;
  Animated<float> inner{0.8F};     ///< radius, length
  Animated<float> outer{1.0F};     ///< radius, length
  Animated<float> rotate_y{0.0F};  ///< degrees
  Animated<float> low{0.0F};       ///< luminance at which the density is 0
  Animated<float> high{1.0F};      ///< and from which on it is 1
  bool tint = true;                ///< scattered light takes the image's colour
  Animated<float> swirl{0.0F};     ///< length by which noise moves the image, at most
  Animated<float> scale{4.0F};     ///< cells of that noise per length
  int octaves = 4;
  Animated<float> time{0.0F};
};

/// How the density of a medium varies in a body; by exactly one of its kinds.
struct DensityDesc {
  std::string vdb;               ///< file
  std::string grid = "density";  ///< of that file
  std::string tint;              ///< grid of that file: colour of scattered light; empty: white
  std::string place = "fit";     ///< of the vdb: fit | native
  TransformList transform;       ///< of the vdb, in the body's space, after `place`
  Animated<Vec3> at{Vec3(0.0F)};
  std::optional<NoiseDensityDesc> noise;
  std::optional<ShellDensityDesc> shell;
  float march = 0.0F;  ///< step length, biased; 0: unbiased tracking
};

/// What a medium's emission is made of where it varies otherwise than its density.
struct GlowDesc {
  std::string grid;              ///< of the density's vdb; empty: none
  std::string temperature;       ///< grid of the density's vdb; empty: none
  Animated<float> kelvin{1.0F};  ///< what its value 1 stands for
};

}  // namespace hyades::core
