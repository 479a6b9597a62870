#include "core/image/encode_8_bits.h"

#include <cmath>

namespace hyades::core {
namespace {

uint8_t code_of(float value) {
  if (!(value > 0.0F)) return 0;  // NaN too
  if (value >= 1.0F) return 255;
  return static_cast<uint8_t>(value * 255.0F + 0.5F);
}

}  // namespace

Result<Codes> encode_8_bits(const Image& image, bool alpha) {
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
  const size_t stride = image.channels.size();
  const size_t pixels = image.data.size() / stride;
  codes.data.resize(pixels * sources.size());
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < sources.size(); ++c) {
      codes.data[i * sources.size() + c] =
          code_of(image.data[i * stride + static_cast<size_t>(sources[c])]);
    }
  }
  return codes;
}

}  // namespace hyades::core
