#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::core {

/// Interleaved codes for PNG, JPEG and TIFF.
struct Codes {
  int channels = 0;  ///< 1: grey, 3: RGB, 4: RGBA
  int bits = 8;      ///< 8, or 16 in this machine's byte order
  std::vector<uint8_t> data;

  size_t row_bytes(int width) const {
    return static_cast<size_t>(width) * static_cast<size_t>(channels) *
           static_cast<size_t>(bits / 8);
  }
};

/// Channels R, G, B[, A] or Y of `image` as codes 0..255 or 0..65535: clamped to 0..1, rounded to
/// nearest, NaN as 0. Alpha only where `alpha`.
Result<Codes> encode_codes(const Image& image, bool alpha, int bits = 8);

}  // namespace hyades::core
