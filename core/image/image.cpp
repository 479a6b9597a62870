#include "core/image/image.h"

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

}  // namespace hyades::core
