#pragma once

#include <cstdint>
#include <vector>

namespace hyades::core {

/// What the numbers of a picture for displays mean; their primaries and white are Rec.709's.
enum class ColorTag {
  srgb,    ///< encoded by the sRGB curve
  linear,  ///< the light itself
  none,    ///< it is not known: nothing is said in the file
};

/// An ICC profile (version 4.3, display class, RGB) of about half a kilobyte that says so:
/// Rec.709's primaries, seen under D50, and the sRGB curve in closed form or a straight line.
/// Always the same bytes; empty for ColorTag::none.
std::vector<uint8_t> icc_profile(ColorTag tag);

}  // namespace hyades::core
