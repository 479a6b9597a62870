#pragma once

#include <array>
#include <optional>

#include "core/image/image.h"

namespace hyades::core {

/// Which channels of an image are its red, green and blue: R, G and B, and Y for those that it
/// lacks. Nothing where it lacks that, too.
std::optional<std::array<int, 3>> rgb_channels(const Image& image);

/// The colour of a pixel, of the channels that rgb_channels() gave.
inline Rgb rgb_at(const Image& image, const std::array<int, 3>& channels, int x, int y) {
  const float* values = &image.data[image.index(x, y, 0)];
  return {values[channels[0]], values[channels[1]], values[channels[2]]};
}

}  // namespace hyades::core
