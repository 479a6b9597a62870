#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/half.h"
#include "core/base/result.h"
#include "core/base/vec.h"
#include "core/textures/texel_store.h"

namespace hyades::core {

/// How the numbers of an image are kept.
enum class TexelFormat : uint8_t {
  bytes,   ///< 8-bit codes and a table of what they mean
  words,   ///< 16-bit codes, likewise
  halves,  ///< 16-bit floating-point
  floats,
};

/// A format and what its codes mean.
struct TexelCoding {
  TexelFormat format = TexelFormat::floats;
  const float* color = nullptr;  ///< bytes and words: the colour channels' table
  const float* alpha = nullptr;  ///< and that of the others
};

inline size_t bytes_of(TexelFormat format) {
  return format == TexelFormat::bytes ? 1 : format == TexelFormat::floats ? 4 : 2;
}

/// The smallest coding that keeps every one of `values` (interleaved channels, of which the first
/// `colors` are colours) exactly. Codes of 8 and 16 bits are tried as sRGB and as linear, so that
/// what came out of such a file goes back into its own codes.
TexelCoding smallest_coding(const std::vector<float>& values, size_t channels, size_t colors);

/// One picture in memory: 1 (grey), 2 (grey and alpha), 3 (colour) or 4 channels in tiles of 8 x 8
/// texels, which keeps neighbours in both directions together. Rows count from below.
class Texels {
 public:
  Texels() = default;

  /// A picture of rows from the top, kept in `store`. Values that `coding` cannot hold are rounded.
  static Result<Texels> make(int width, int height, int channels, const std::vector<float>& values,
                             const TexelCoding& coding, TexelStore& store);

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }
  TexelFormat format() const { return coding_.format; }
  size_t memory() const { return bytes_.size(); }

  /// Red, green, blue (all the same where grey) and alpha (1 where there is none) of texel (x, y);
  /// zero where one of them is negative. `format` is format(), known where this is asked for.
  template <TexelFormat format>
  Vec4 texel(int x, int y) const {
    if ((x | y) < 0) return Vec4(0.0F);
    const size_t first = index(x, y);
    switch (channels_) {
      case 1:
        return Vec4(Vec3(color<format>(first)), 1.0F);
      case 2:
        return Vec4(Vec3(color<format>(first)), alpha<format>(first + 1));
      case 3:
        return Vec4(color<format>(first), color<format>(first + 1), color<format>(first + 2), 1.0F);
      default:
        return Vec4(color<format>(first), color<format>(first + 1), color<format>(first + 2),
                    alpha<format>(first + 3));
    }
  }

 private:
  static constexpr int kSide = 8;  ///< of a tile

  /// Where the texel's first channel lies in memory.
  size_t index(int x, int y) const {
    const int tile = (y / kSide) * tiles_across_ + x / kSide;
    const int inside = (y % kSide) * kSide + x % kSide;
    return (static_cast<size_t>(tile) * (kSide * kSide) + static_cast<size_t>(inside)) *
           static_cast<size_t>(channels_);
  }

  template <TexelFormat format>
  float color(size_t i) const {
    return value<format>(i, coding_.color);
  }
  template <TexelFormat format>
  float alpha(size_t i) const {
    return value<format>(i, coding_.alpha);
  }
  template <TexelFormat format>
  float value(size_t i, const float* table) const {
    if constexpr (format == TexelFormat::bytes) {
      return table[reinterpret_cast<const uint8_t*>(data_)[i]];
    } else if constexpr (format == TexelFormat::words) {
      return table[reinterpret_cast<const uint16_t*>(data_)[i]];
    } else if constexpr (format == TexelFormat::halves) {
      return from_half(reinterpret_cast<const uint16_t*>(data_)[i]);
    } else {
      return reinterpret_cast<const float*>(data_)[i];
    }
  }

  int width_ = 0;
  int height_ = 0;
  int channels_ = 0;
  int tiles_across_ = 0;
  TexelCoding coding_;
  const std::byte* data_ = nullptr;  ///< of bytes_
  Bytes bytes_;
};

}  // namespace hyades::core
