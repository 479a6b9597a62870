#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/image/decoders.h"

/// Truevision TGA pictures (specification: "Truevision TGA File Format Specification", version 2.0,
/// 1991): colour, grey and palettes, plain or run-length coded.
namespace hyades::core {
namespace {

constexpr size_t kTgaHeaderSize = 18;

struct TgaHeader {
  int id_length = 0;
  bool has_palette = false;
  int kind = 0;  ///< 1 palette, 2 colour, 3 grey
  bool packed = false;
  int palette_first = 0;
  int palette_length = 0;
  int palette_bits = 0;
  int width = 0;
  int height = 0;
  int bits = 0;  ///< of a pixel in the file
  bool right_to_left = false;
  bool top_down = false;
};

TgaHeader parse_tga_header(std::span<const std::byte> file) {
  const auto byte = [&](size_t at) { return std::to_integer<int>(file[at]); };
  const auto word = [&](size_t at) { return byte(at) | byte(at + 1) << 8; };
  TgaHeader header;
  header.id_length = byte(0);
  header.has_palette = byte(1) == 1;
  header.kind = byte(2) & 7;
  header.packed = byte(2) >= 9;
  header.palette_first = word(3);
  header.palette_length = word(5);
  header.palette_bits = byte(7);
  header.width = word(12);
  header.height = word(14);
  header.bits = byte(16);
  header.right_to_left = (byte(17) & 16) != 0;
  header.top_down = (byte(17) & 32) != 0;
  return header;
}

bool is_color_depth(int bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; }

/// Codes of a pixel: red, green, blue, alpha; grey ones have the same three.
using TgaCodes = std::array<uint8_t, 4>;

uint8_t from_5_bits(int code) { return static_cast<uint8_t>((code * 255 + 15) / 31); }

/// A colour as it lies in the file, blue first.
TgaCodes color_of(const std::byte* at, int bits) {
  const auto byte = [&](int i) { return std::to_integer<uint8_t>(at[i]); };
  if (bits <= 16) {
    const int word = byte(0) | byte(1) << 8;
    return {from_5_bits(word >> 10 & 31), from_5_bits(word >> 5 & 31), from_5_bits(word & 31), 255};
  }
  return {byte(2), byte(1), byte(0), bits == 32 ? byte(3) : uint8_t{255}};
}

/// The pixels of a file one after another, unpacked.
class TgaPixels {
 public:
  TgaPixels(const TgaHeader& header, std::span<const std::byte> palette,
            std::span<const std::byte> left)
      : header_(header),
        palette_(palette),
        left_(left),
        size_(static_cast<size_t>(header.bits + 7) / 8) {}

  /// False where the file ends before, or names a colour that its palette lacks.
  bool next(TgaCodes& codes) {
    if (header_.packed) {
      if (count_ == 0) {
        if (left_.empty()) return false;
        const int head = std::to_integer<int>(left_[0]);
        left_ = left_.subspan(1);
        count_ = (head & 127) + 1;
        is_run_ = head >= 128;
        run_is_known_ = false;
      }
      --count_;
      if (is_run_ && run_is_known_) {
        codes = run_;
        return true;
      }
    }
    if (left_.size() < size_ || !decode(codes)) return false;
    left_ = left_.subspan(size_);
    run_ = codes;
    run_is_known_ = true;
    return true;
  }

 private:
  bool decode(TgaCodes& codes) const {
    const auto first = std::to_integer<uint8_t>(left_[0]);
    if (header_.kind == 2) {
      codes = color_of(left_.data(), header_.bits);
      return true;
    }
    if (header_.kind == 3) {
      const auto alpha = size_ == 2 ? std::to_integer<uint8_t>(left_[1]) : uint8_t{255};
      codes = {first, first, first, alpha};
      return true;
    }
    const int index = size_ == 2 ? first | std::to_integer<int>(left_[1]) << 8 : first;
    const int place = index - header_.palette_first;
    if (place < 0 || place >= header_.palette_length) return false;
    const auto entry = static_cast<size_t>(header_.palette_bits + 7) / 8;
    codes = color_of(palette_.data() + static_cast<size_t>(place) * entry, header_.palette_bits);
    return true;
  }

  const TgaHeader& header_;
  std::span<const std::byte> palette_;
  std::span<const std::byte> left_;
  size_t size_;    ///< bytes of a pixel
  int count_ = 0;  ///< pixels left of a packet
  bool is_run_ = false;
  bool run_is_known_ = false;
  TgaCodes run_ = {};
};

}  // namespace

bool looks_like_tga(std::span<const std::byte> file) {
  if (file.size() < kTgaHeaderSize) return false;
  const int type = std::to_integer<int>(file[2]);
  if (!((type >= 1 && type <= 3) || (type >= 9 && type <= 11))) return false;
  if (std::to_integer<int>(file[1]) > 1 || (std::to_integer<int>(file[17]) & 0xC0) != 0) {
    return false;
  }
  const TgaHeader header = parse_tga_header(file);
  if (header.width == 0 || header.height == 0) return false;
  if (header.kind == 2) return is_color_depth(header.bits);
  if (header.bits != 8 && header.bits != 16) return false;
  return header.kind == 3 || (header.has_palette && is_color_depth(header.palette_bits));
}

Result<Image> decode_tga(std::span<const std::byte> file, bool srgb, const ImageLimits& limits) {
  if (!looks_like_tga(file)) return Error{"the header is damaged"};
  const TgaHeader header = parse_tga_header(file);
  const bool grey = header.kind == 3;
  const bool alpha =
      grey ? header.bits == 16 : (header.kind == 1 ? header.palette_bits : header.bits) == 32;
  const int channels = (grey ? 1 : 3) + (alpha ? 1 : 0);
  if (const Status size = check_image_size(header.width, header.height, channels, limits); !size) {
    return size.error();
  }
  const size_t palette_size = header.has_palette
                                  ? static_cast<size_t>(header.palette_length) *
                                        (static_cast<size_t>(header.palette_bits + 7) / 8)
                                  : 0;
  const size_t begin = kTgaHeaderSize + static_cast<size_t>(header.id_length) + palette_size;
  // A packet of a run says 128 pixels at most.
  const uint64_t pixel_count = uint64_t(header.width) * uint64_t(header.height);
  const uint64_t pixel_size = static_cast<uint64_t>(header.bits + 7) / 8;
  const uint64_t least =
      header.packed ? (pixel_count + 127) / 128 * (1 + pixel_size) : pixel_count * pixel_size;
  if (file.size() < begin || file.size() - begin < least) return Error{"the file is truncated"};

  TgaPixels pixels(header, file.subspan(begin - palette_size, palette_size), file.subspan(begin));
  std::vector<std::string> names =
      grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  if (alpha) names.emplace_back("A");
  Image image = make_image(header.width, header.height, names);
  const float* linear = linear_of_8_bits(srgb);
  for (int row = 0; row < header.height; ++row) {
    const int y = header.top_down ? row : header.height - 1 - row;
    for (int column = 0; column < header.width; ++column) {
      TgaCodes codes;
      if (!pixels.next(codes)) {
        return Error{fmt::format("row {} of {} is damaged or missing", row + 1, header.height)};
      }
      const int x = header.right_to_left ? header.width - 1 - column : column;
      float* out = &image.at(x, y, 0);
      for (size_t c = 0; c < (grey ? 1U : 3U); ++c) *out++ = linear[codes[c]];
      if (alpha) *out = static_cast<float>(codes[3]) / 255.0F;
    }
  }
  if (alpha) ignore_empty_alpha(image);
  return image;
}

}  // namespace hyades::core
