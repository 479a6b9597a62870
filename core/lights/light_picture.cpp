#include "core/lights/light_picture.h"

#include <algorithm>
#include <array>

namespace hyades::core {
namespace {

constexpr float kLargest = 1e15F;  ///< its square must be finite

bool is_clean(float value) { return value >= 0.0F && value <= kLargest; }

/// The image itself, or a copy without what is no radiance.
std::shared_ptr<const Image> clean(std::shared_ptr<const Image> image) {
  if (std::all_of(image->data.begin(), image->data.end(), is_clean)) return image;
  auto copy = std::make_shared<Image>(*image);
  for (float& value : copy->data) {
    if (!is_clean(value)) value = value > 0.0F ? kLargest : 0.0F;
  }
  return copy;
}

}  // namespace

LightPicture::LightPicture(std::shared_ptr<const Image> image)
    : image_(clean(std::move(image))),
      channels_(rgb_channels(*image_).value_or(std::array{0, 0, 0})) {}

}  // namespace hyades::core
