#include "import/stand_in.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/job/output_path.h"

namespace hyades::core {

namespace {

constexpr std::array<std::string_view, 14> kPictures = {".png", ".jpg", ".jpeg", ".tif", ".tiff",
                                                        ".qoi", ".pfm", ".ppm",  ".pgm", ".exr",
                                                        ".hdr", ".tga", ".bmp",  ".webp"};

void put_number(std::vector<uint8_t>& out, uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<uint8_t>(number >> shift));
}

/// A chunk of a PNG: length, name, data, checksum.
void put_chunk(std::vector<uint8_t>& out, std::string_view name, const std::vector<uint8_t>& data) {
  put_number(out, static_cast<uint32_t>(data.size()));
  const size_t begin = out.size();
  out.insert(out.end(), name.begin(), name.end());
  out.insert(out.end(), data.begin(), data.end());
  const uLong sum = crc32(0, out.data() + begin, static_cast<uInt>(out.size() - begin));
  put_number(out, static_cast<uint32_t>(sum));
}

}  // namespace

bool names_picture(const std::string& reference) {
  const std::string extension = file_extension(reference);
  return std::find(kPictures.begin(), kPictures.end(), extension) != kPictures.end();
}

Bytes magenta_picture() {
  static const auto png = [] {
    std::vector<uint8_t> out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    // One pixel wide and high, 8 bits each of red, green and blue.
    put_chunk(out, "IHDR", {0, 0, 0, 1, 0, 0, 0, 1, 8, 2, 0, 0, 0});
    const std::array<uint8_t, 4> row = {0, 255, 0, 255};  // the filter 'none', then the pixel
    std::vector<uint8_t> packed(compressBound(row.size()));
    uLongf size = packed.size();
    compress(packed.data(), &size, row.data(), row.size());
    packed.resize(size);
    put_chunk(out, "IDAT", packed);
    put_chunk(out, "IEND", {});
    return std::make_shared<const std::vector<uint8_t>>(std::move(out));
  }();
  return {png, std::as_bytes(std::span(*png))};
}

}  // namespace hyades::core
