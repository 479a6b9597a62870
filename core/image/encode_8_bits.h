#pragma once

#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::core {

/// Interleaved 8-bit codes for PNG and JPEG.
struct Codes {
  int channels = 0;  ///< 1: grey, 3: RGB, 4: RGBA
  std::vector<uint8_t> data;
};

/// Channels R, G, B[, A] or Y of `image` as codes 0..255: clamped to 0..1, rounded to nearest, NaN
/// as 0. Alpha only where `alpha`.
Result<Codes> encode_8_bits(const Image& image, bool alpha);

}  // namespace hyades::core
