#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/hash.h"
#include "core/image/image.h"
#include "tests/support/exact_bytes.h"

namespace hyades::test {

inline std::string file_contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The checksum of a chunk's type and data (PNG specification, annex D).
inline uint32_t png_crc(std::string_view bytes) {
  uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    crc ^= static_cast<uint8_t>(byte);
    for (int i = 0; i < 8; ++i) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

/// A picture of hashed values in [0, 1).
inline core::Image hashed_image(int width, int height, std::vector<std::string> channels) {
  core::Image image = core::make_image(width, height, std::move(channels));
  for (size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<float>(core::mix64(i + 1) >> 40) * 0x1p-24F;
  }
  return image;
}

inline float largest_difference(const core::Image& a, const core::Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels) return 1e30F;
  float largest = 0.0F;
  for (size_t i = 0; i < a.data.size(); ++i) {
    largest = std::max(largest, std::abs(a.data[i] - b.data[i]));
  }
  return largest;
}

}  // namespace hyades::test
