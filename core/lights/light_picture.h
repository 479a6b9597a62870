#pragma once

#include <array>
#include <memory>
#include <utility>

#include "core/image/rgb_channels.h"

namespace hyades::core {

/// The pixels of an image with channels R, G, B or Y and at least one pixel, as light: negative
/// values and NaN count as black, at most 1e15 is seen. Immutable and thread-safe.
class LightPicture {
 public:
  explicit LightPicture(std::shared_ptr<const Image> image);

  int width() const { return image_->width; }
  int height() const { return image_->height; }
  Rgb at(int x, int y) const { return rgb_at(*image_, channels_, x, y); }

 private:
  std::shared_ptr<const Image> image_;  ///< without negative, broken or overwhelming values
  std::array<int, 3> channels_;
};

}  // namespace hyades::core
