#include "core/image/rgb_channels.h"

#include <cstddef>

namespace hyades::core {

std::optional<std::array<int, 3>> rgb_channels(const Image& image) {
  const std::array<const char*, 3> names{"R", "G", "B"};
  std::array<int, 3> channels{};
  for (size_t c = 0; c < 3; ++c) {
    channels[c] = image.find_channel(names[c]);
    if (channels[c] < 0) channels[c] = image.find_channel("Y");
    if (channels[c] < 0) return std::nullopt;
  }
  return channels;
}

}  // namespace hyades::core
