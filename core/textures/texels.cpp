#include "core/textures/texels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/image/decoders.h"

namespace hyades::core {
namespace {

/// The code whose value is nearest to `x`, of an increasing table.
uint32_t nearest_code(const float* table, uint32_t last, float x) {
  const float* after = std::lower_bound(table, table + last, x);
  const auto code = static_cast<uint32_t>(after - table);
  return code > 0 && x - table[code - 1] < table[code] - x ? code - 1 : code;
}

/// Finds the codes of many values: those of one 8-bit picture repeat, and are looked up by their
/// leading bits first.
class Coder {
 public:
  Coder(const float* table, uint32_t last) : table_(table), last_(last), guess_(kKeys) {
    for (uint32_t code = 0; code <= last; ++code) guess_[key(table[code])] = code;
  }

  uint32_t code(float x) const {
    const uint32_t guess = guess_[key(x)];
    return table_[guess] == x ? guess : nearest_code(table_, last_, x);
  }

  bool holds(float x) const {
    return x >= 0.0F && x <= 1.0F && table_[code(x)] == x && !(x == 0.0F && std::signbit(x));
  }

 private:
  static constexpr uint32_t kShift = 12;
  static constexpr uint32_t kKeys = (0x3F800000U >> kShift) + 1;

  static uint32_t key(float x) { return std::min(std::bit_cast<uint32_t>(x) >> kShift, kKeys - 1); }

  const float* table_;
  uint32_t last_;
  std::vector<uint32_t> guess_;
};

bool coded(const std::vector<float>& values, size_t channels, size_t colors, const Coder& color,
           const Coder& alpha) {
  for (size_t i = 0; i < values.size(); i += channels) {
    for (size_t c = 0; c < channels; ++c) {
      if (!(c < colors ? color : alpha).holds(values[i + c])) return false;
    }
  }
  return true;
}

bool fits_halves(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) {
    return std::bit_cast<uint32_t>(from_half(to_half(x))) == std::bit_cast<uint32_t>(x);
  });
}

}  // namespace

TexelCoding smallest_coding(const std::vector<float>& values, size_t channels, size_t colors) {
  const auto try_codes = [&](TexelFormat format, uint32_t last, auto tables, TexelCoding& coding) {
    const Coder linear(tables(false), last);
    for (const bool srgb : {true, false}) {
      coding = {format, tables(srgb), tables(false)};
      const Coder color(tables(srgb), last);
      if (coded(values, channels, colors, color, linear)) return true;
    }
    return false;
  };
  TexelCoding coding;
  if (try_codes(TexelFormat::bytes, 255, linear_of_8_bits, coding)) return coding;
  if (fits_halves(values)) return {TexelFormat::halves, nullptr, nullptr};
  if (try_codes(TexelFormat::words, 65535, linear_of_16_bits, coding)) return coding;
  return {};
}

Result<Texels> Texels::make(int width, int height, int channels, const std::vector<float>& values,
                            const TexelCoding& coding, TexelStore& store) {
  Texels texels;
  texels.width_ = width;
  texels.height_ = height;
  texels.channels_ = channels;
  texels.tiles_across_ = (width + kSide - 1) / kSide;
  texels.coding_ = coding;
  const auto tiles =
      static_cast<size_t>(texels.tiles_across_) * static_cast<size_t>((height + kSide - 1) / kSide);
  const auto per_texel = static_cast<size_t>(channels);
  const size_t each = bytes_of(coding.format);
  std::vector<std::byte> data(tiles * (kSide * kSide) * per_texel * each);
  const bool codes = coding.format == TexelFormat::bytes || coding.format == TexelFormat::words;
  const uint32_t last = coding.format == TexelFormat::bytes ? 255 : codes ? 65535 : 0;
  const float nothing = 0.0F;
  const Coder color(codes ? coding.color : &nothing, last);
  const Coder alpha(codes ? coding.alpha : &nothing, last);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float* from =
          &values[(static_cast<size_t>(height - 1 - y) * static_cast<size_t>(width) +
                   static_cast<size_t>(x)) *
                  per_texel];
      std::byte* to = data.data() + texels.index(x, y) * each;
      for (int c = 0; c < channels; ++c, to += each) {
        const bool is_alpha = c + 1 == channels && channels % 2 == 0;
        if (codes) {
          const auto code = static_cast<uint16_t>((is_alpha ? alpha : color).code(from[c]));
          std::memcpy(to, &code, each);  // little-endian: the low byte first
        } else if (coding.format == TexelFormat::halves) {
          const uint16_t half = to_half(from[c]);
          std::memcpy(to, &half, each);
        } else {
          std::memcpy(to, &from[c], each);
        }
      }
    }
  }
  auto kept = store.keep(std::move(data));
  if (!kept) return kept.error();
  texels.bytes_ = std::move(*kept);
  texels.data_ = texels.bytes_.span().data();
  return texels;
}

}  // namespace hyades::core
