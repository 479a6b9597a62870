#include "core/image/encode_codes.h"

#include <cmath>
#include <cstring>

namespace hyades::core {
namespace {

uint32_t code_of(float value, float largest) {
  if (!(value > 0.0F)) return 0;  // NaN too
  if (value >= 1.0F) return static_cast<uint32_t>(largest);
  return static_cast<uint32_t>(value * largest + 0.5F);
}

}  // namespace

Result<Codes> encode_codes(const Image& image, bool alpha, int bits) {
  if (image.width <= 0 || image.height <= 0) return Error{"the picture is empty"};
  std::vector<int> sources;
  if (image.find_channel("R") >= 0) {
    sources = {image.find_channel("R"), image.find_channel("G"), image.find_channel("B")};
    if (alpha && image.find_channel("A") >= 0) sources.push_back(image.find_channel("A"));
  } else {
    sources = {image.find_channel("Y")};
  }
  for (const int source : sources) {
    if (source < 0) return Error{"the picture has neither channels R, G, B nor channel Y"};
  }
  Codes codes;
  codes.channels = static_cast<int>(sources.size());
  codes.bits = bits;
  const size_t stride = image.channels.size();
  const size_t pixels = image.data.size() / stride;
  const size_t count = pixels * sources.size();
  codes.data.resize(count * static_cast<size_t>(bits / 8));
  for (size_t i = 0; i < count; ++i) {
    const float value =
        image.data[i / sources.size() * stride + static_cast<size_t>(sources[i % sources.size()])];
    if (bits == 8) {
      codes.data[i] = static_cast<uint8_t>(code_of(value, 255.0F));
    } else {
      const auto code = static_cast<uint16_t>(code_of(value, 65535.0F));
      std::memcpy(&codes.data[2 * i], &code, 2);
    }
  }
  return codes;
}

}  // namespace hyades::core
