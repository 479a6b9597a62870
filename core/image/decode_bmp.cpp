#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image/decoders.h"

/// Windows bitmaps (documentation: "Bitmap Storage" and "BITMAPV5HEADER structure", Win32 API): of
/// 1, 4 and 8 bits with a palette, of 16, 24 and 32 bits with any masks; not run-length coded.
namespace hyades::core {
namespace {

constexpr uint32_t kPlain = 0;
constexpr uint32_t kMasks = 3;
constexpr uint32_t kMasksWithAlpha = 6;

struct Header {
  uint32_t pixels_at = 0;
  uint32_t header_size = 0;
  int64_t width = 0;
  int64_t height = 0;
  bool top_down = false;
  int bits = 0;
  uint32_t packing = kPlain;
  uint32_t palette_length = 0;
  std::array<uint32_t, 4> masks = {};  ///< of red, green, blue, alpha
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> file) : file_(file) {}

  bool holds(size_t at, size_t count) const {
    return at <= file_.size() && count <= file_.size() - at;
  }
  uint32_t byte(size_t at) const { return std::to_integer<uint32_t>(file_[at]); }
  uint32_t word(size_t at) const { return byte(at) | byte(at + 1) << 8; }
  uint32_t number(size_t at) const { return word(at) | word(at + 2) << 16; }

 private:
  std::span<const std::byte> file_;
};

constexpr size_t kFileHeader = 14;

Result<Header> parse_header(const Reader& file) {
  if (!file.holds(0, kFileHeader + 40)) return Error{"the file is truncated"};
  Header header;
  header.pixels_at = file.number(10);
  header.header_size = file.number(14);
  if (header.header_size < 40) return Error{"headers of OS/2 are not read"};
  const auto height = static_cast<int32_t>(file.number(22));
  header.width = static_cast<int32_t>(file.number(18));
  header.height = height < 0 ? -int64_t{height} : height;
  header.top_down = height < 0;
  header.bits = static_cast<int>(file.word(28));
  header.packing = file.number(30);
  header.palette_length = file.number(46);
  if (header.packing != kPlain && header.packing != kMasks && header.packing != kMasksWithAlpha) {
    return Error{"packed pixels are not read; save it as PNG"};
  }
  if (header.bits <= 8) {
    if (header.bits != 1 && header.bits != 4 && header.bits != 8) {
      return Error{fmt::format("pixels of {} bits are not read", header.bits)};
    }
    const uint32_t most = 1U << header.bits;
    if (header.palette_length == 0 || header.palette_length > most) header.palette_length = most;
    return header;
  }
  if (header.bits != 16 && header.bits != 24 && header.bits != 32) {
    return Error{fmt::format("pixels of {} bits are not read", header.bits)};
  }
  header.masks = header.bits == 16 ? std::array<uint32_t, 4>{0x7C00, 0x03E0, 0x001F, 0}
                                   : std::array<uint32_t, 4>{0xFF0000, 0xFF00, 0xFF, 0};
  if (header.bits == 32) header.masks[3] = 0xFF000000;
  if (header.packing != kPlain && header.bits != 24) {
    const bool alpha = header.packing == kMasksWithAlpha || header.header_size >= 56;
    const size_t count = alpha ? 4 : 3;
    header.masks[3] = 0;
    if (!file.holds(kFileHeader + 40, count * 4)) return Error{"the file is truncated"};
    for (size_t c = 0; c < count; ++c) {
      header.masks[c] = file.number(kFileHeader + 40 + c * 4);
      const uint32_t ones = header.masks[c] >> std::countr_zero(header.masks[c] | 1U << 31);
      if ((ones & (ones + 1)) != 0) return Error{"a channel's mask has gaps"};
    }
  }
  return header;
}

/// The part of `pixel` that a mask shows, from 0 to 1.
float part(uint32_t pixel, uint32_t mask) {
  if (mask == 0) return 0.0F;
  const int shift = std::countr_zero(mask);
  return static_cast<float>((pixel & mask) >> shift) / static_cast<float>(mask >> shift);
}

/// The code of 8 bits that is nearest to `value` of 0..1.
size_t code_of(float value) { return static_cast<size_t>(value * 255.0F + 0.5F); }

}  // namespace

Result<Image> decode_bmp(std::span<const std::byte> bytes, bool srgb, const ImageLimits& limits) {
  const Reader file(bytes);
  const Result<Header> parsed = parse_header(file);
  if (!parsed) return parsed.error();
  const Header& header = *parsed;
  const bool alpha = header.masks[3] != 0;
  const size_t channels = alpha ? 4 : 3;
  if (const Status size =
          check_image_size(header.width, header.height, static_cast<int64_t>(channels), limits);
      !size) {
    return size.error();
  }
  const auto width = static_cast<size_t>(header.width);
  const auto height = static_cast<size_t>(header.height);
  const size_t row_size = (width * static_cast<size_t>(header.bits) + 31) / 32 * 4;
  if (!file.holds(header.pixels_at, row_size * height)) return Error{"the file is truncated"};
  const size_t palette_at = kFileHeader + header.header_size;
  const bool has_palette = header.bits <= 8;
  if (has_palette && !file.holds(palette_at, size_t{header.palette_length} * 4)) {
    return Error{"the palette is truncated"};
  }
  const float* linear = linear_of_8_bits(srgb);
  Image image = make_image(static_cast<int>(width), static_cast<int>(height), {"R", "G", "B"});
  if (alpha) {
    image = make_image(static_cast<int>(width), static_cast<int>(height), {"R", "G", "B", "A"});
  }
  for (size_t row = 0; row < height; ++row) {
    const size_t at = header.pixels_at + row * row_size;
    const auto y = static_cast<int>(header.top_down ? row : height - 1 - row);
    for (size_t x = 0; x < width; ++x) {
      float* out = &image.at(static_cast<int>(x), y, 0);
      if (has_palette) {
        const size_t bit = x * static_cast<size_t>(header.bits);
        const auto shift = 8 - static_cast<unsigned>(header.bits) - static_cast<unsigned>(bit % 8);
        const uint32_t index = file.byte(at + bit / 8) >> shift & ((1U << header.bits) - 1);
        if (index >= header.palette_length) {
          return Error{fmt::format("row {} has a colour that the palette lacks", row + 1)};
        }
        for (size_t c = 0; c < 3; ++c) out[c] = linear[file.byte(palette_at + index * 4 + 2 - c)];
        continue;
      }
      const auto size = static_cast<size_t>(header.bits) / 8;
      uint32_t pixel = file.word(at + x * size);
      if (size > 2) pixel |= file.byte(at + x * size + 2) << 16;
      if (size > 3) pixel |= file.byte(at + x * size + 3) << 24;
      for (size_t c = 0; c < 3; ++c) out[c] = linear[code_of(part(pixel, header.masks[c]))];
      if (alpha) out[3] = part(pixel, header.masks[3]);
    }
  }
  if (alpha) ignore_empty_alpha(image);
  return image;
}

}  // namespace hyades::core
