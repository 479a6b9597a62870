#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/vec.h"

namespace hyades::core {

/// Where a picture lies in a larger frame, in pixels; frame_width 0: it is a whole frame.
struct ImageWindow {
  int x = 0;  ///< of the left column
  int y = 0;  ///< of the top row
  int frame_width = 0;
  int frame_height = 0;

  bool in_frame() const { return frame_width > 0; }
  friend bool operator==(const ImageWindow&, const ImageWindow&) = default;
};

/// Pixels in memory: interleaved float channels, row 0 on top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels;  ///< "R", "G", "B", "A", "Y", "albedo.R", ... in order
  std::vector<float> data;            ///< width * height * channels.size()
  ImageWindow placement = {};         ///< kept by EXR files (data and display window) only

  int channel_count() const { return static_cast<int>(channels.size()); }
  size_t index(int x, int y, int c) const {
    return (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
               channels.size() +
           static_cast<size_t>(c);
  }
  float at(int x, int y, int c) const { return data[index(x, y, c)]; }
  float& at(int x, int y, int c) { return data[index(x, y, c)]; }

  /// Index of channel `name`, or -1.
  int find_channel(const std::string& name) const;
};

/// A black image.
Image make_image(int width, int height, std::vector<std::string> channels);

/// The part [x, x + width) x [y, y + height) of `image`, which must hold it, counted from its own
/// first pixel.
Image cut_out(const Image& image, int x, int y, int width, int height);

}  // namespace hyades::core
