#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/job/animated.h"
#include "core/job/fields.h"
#include "core/job/inputs.h"
#include "core/job/transform_desc.h"

namespace hyades::core {

/// A density made of noise, within the bounds of the body that it fills.
struct NoiseDensityDesc {
  Animated<Vec3> scale{Vec3(1.0F)};
  Animated<Vec3> offset{Vec3(0.0F)};
  int octaves = 5;
  Animated<float> lacunarity{2.0F};
  Animated<float> gain{0.5F};
  Animated<float> time{0.0F};  ///< the fourth coordinate
  Animated<float> low{0.5F};   ///< noise, 0 to 1, at which the density is 0
  Animated<float> high{0.7F};  ///< and from which on it is 1
  Animated<float> fade{0.0F};  ///< share of the way to the middle on which it thins out

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.animated_scale("scale", self.scale, kAnyNumber.in("1/length"));
    visit.animated_scale("offset", self.offset, kAnyNumber);
    visit.integer("octaves", self.octaves, 1, 16);
    visit.animated("lacunarity", self.lacunarity, {1.0, 16.0});
    visit.animated("gain", self.gain, {0.0, 4.0});
    visit.animated("time", self.time, kAnyNumber);
    visit.animated("low", self.low, kUnitInterval);
    visit.animated("high", self.high, kUnitInterval);
    visit.animated("fade", self.fade, kUnitInterval);
  }
};

/// An image of all directions, wrapped around the body's origin, whose bright parts are dense.
struct ShellDensityDesc {
  std::string image;
  Animated<float> inner{0.8F};  ///< radius
  Animated<float> outer{1.0F};  ///< radius
  Animated<float> rotate_y{0.0F};
  Animated<float> low{0.0F};    ///< luminance at which the density is 0
  Animated<float> high{1.0F};   ///< and from which on it is 1
  bool tint = true;             ///< scattered light takes the image's colour
  Animated<float> swirl{0.0F};  ///< how far noise moves the image, at most
  Animated<float> scale{4.0F};  ///< cells of that noise
  int octaves = 4;
  Animated<float> time{0.0F};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.require("image", "an image file");
    visit.file("image", self.image);
    visit.animated("inner", self.inner, kNotNegative.in("length"));
    visit.animated("outer", self.outer, kPositive.in("length"));
    visit.animated("rotate_y", self.rotate_y, kAnyNumber.in("degrees"));
    visit.animated("low", self.low, kNotNegative);
    visit.animated("high", self.high, kNotNegative);
    visit.flag("tint", self.tint);
    visit.animated("swirl", self.swirl, kNotNegative.in("length"));
    visit.animated("scale", self.scale, kNotNegative.in("1/length"));
    visit.integer("octaves", self.octaves, 1, 16);
    visit.animated("time", self.time, kAnyNumber);
  }
};

inline const std::array<std::string, 2> kVdbPlaceNames = {"fit", "native"};

/// How the density of a medium varies in a body; by exactly one of its kinds.
struct DensityDesc {
  std::string vdb;               ///< file, or one for each frame (frame_files.h)
  std::string grid = "density";  ///< of that file
  std::string tint;              ///< grid of that file: colour of scattered light; empty: white
  std::string place = kVdbPlaceNames[0];  ///< of the vdb: of kVdbPlaceNames
  TransformList transform;                ///< of the vdb, in the body's space, after `place`
  Animated<Vec3> at{Vec3(0.0F)};
  std::optional<NoiseDensityDesc> noise;
  std::optional<ShellDensityDesc> shell;
  float march = 0.0F;  ///< step length, biased; 0: unbiased tracking

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.frame_file("vdb", self.vdb, FrameFiles::own);
    visit.text("grid", self.grid, "the name of a grid of numbers in the file");
    visit.text("tint", self.tint, "the name of a grid of colours in the file");
    visit.choice("place", self.place, kVdbPlaceNames);
    visit.place(self.transform, self.at);
    visit.map("noise", "media.density.noise", self.noise);
    visit.map("shell", "media.density.shell", self.shell);
    visit.number("march", self.march, kNotNegative.in("length"));
  }
};

}  // namespace hyades::core
