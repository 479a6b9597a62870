#pragma once

#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::core {

/// How different two pictures look from a distance at which their noise cannot be seen.
struct PerceptualDifference {
  double mean = 0.0;     ///< of all pixels; below 1 or so nobody sees it
  double largest = 0.0;  ///< of the means of 12 x 12 fields of the picture
  int x = 0;             ///< of that field's first pixel
  int y = 0;
};

/// Distances in CIELAB (CIE 1976, D65) of the pictures' channels R, G, B, both blurred by a
/// Gaussian whose standard deviation is a hundredth of their width: a simple form of S-CIELAB
/// (Zhang and Wandell 1996), which blurs by what the eye cannot resolve. Channels are linear
/// display values, as read_image returns those of PNG and JPEG files; what is beyond 0..1 is
/// clipped. Error: sizes differ, or there are no R, G, B.
Result<PerceptualDifference> perceptual_difference(const Image& a, const Image& b);

}  // namespace hyades::core
