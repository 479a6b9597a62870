#include "core/image/image.h"

#include <algorithm>
#include <utility>

namespace hyades::core {

int Image::find_channel(const std::string& name) const {
  for (size_t i = 0; i < channels.size(); ++i) {
    if (channels[i] == name) return static_cast<int>(i);
  }
  return -1;
}

Image make_image(int width, int height, std::vector<std::string> channels) {
  Image image;
  image.width = width;
  image.height = height;
  image.channels = std::move(channels);
  image.data.assign(
      static_cast<size_t>(width) * static_cast<size_t>(height) * image.channels.size(), 0.0F);
  return image;
}

Image cut_out(const Image& image, int x, int y, int width, int height) {
  Image part = make_image(width, height, image.channels);
  part.placement = image.placement;
  part.placement.x += x;
  part.placement.y += y;
  const size_t row = static_cast<size_t>(width) * image.channels.size();
  for (int j = 0; j < height; ++j) {
    std::copy_n(image.data.begin() + static_cast<ptrdiff_t>(image.index(x, y + j, 0)), row,
                part.data.begin() + static_cast<ptrdiff_t>(part.index(0, j, 0)));
  }
  return part;
}

}  // namespace hyades::core
