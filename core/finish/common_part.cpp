#include "core/finish/common_part.h"

#include <fmt/format.h>

#include "core/base/rect.h"

namespace hyades::core {
namespace {

ImageWindow whole(const Image& image) { return {0, 0, image.width, image.height}; }

ImageWindow placement_of(const Image& image) {
  return image.placement.in_frame() ? image.placement : whole(image);
}

PixelRect window_of(const Image& image) {
  const ImageWindow place = placement_of(image);
  return {place.x, place.y, place.x + image.width, place.y + image.height};
}

Image part_of(const Image& image, const PixelRect& window) {
  const ImageWindow place = placement_of(image);
  return cut_out(image, window.x0 - place.x, window.y0 - place.y, window.width(), window.height());
}

}  // namespace

Status cut_to_common_part(Image& a, Image& b) {
  if (a.placement == b.placement) return {};
  const ImageWindow in_a = placement_of(a);
  const ImageWindow in_b = placement_of(b);
  if (in_a.frame_width != in_b.frame_width || in_a.frame_height != in_b.frame_height) {
    return Error{fmt::format("the frames have different sizes: {} x {} and {} x {}",
                             in_a.frame_width, in_a.frame_height, in_b.frame_width,
                             in_b.frame_height)};
  }
  const PixelRect common = intersection(window_of(a), window_of(b));
  if (common.empty()) return Error{"the pictures show different parts of the frame"};
  if (window_of(a) != common) a = part_of(a, common);
  if (window_of(b) != common) b = part_of(b, common);
  return {};
}

}  // namespace hyades::core
