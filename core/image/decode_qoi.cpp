#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/image/decoders.h"

/// Quite OK Image (specification: "The Quite OK Image Format", version 1.0, 2022).
namespace hyades::core {
namespace {

constexpr size_t kHeaderSize = 14;

using QoiCodes = std::array<uint8_t, 4>;  ///< red, green, blue, alpha

size_t place_of(const QoiCodes& p) {
  return (size_t{p[0]} * 3 + size_t{p[1]} * 5 + size_t{p[2]} * 7 + size_t{p[3]} * 11) % 64;
}

/// The pixels of a file one after another, unpacked.
class QoiPixels {
 public:
  explicit QoiPixels(std::span<const std::byte> left) : left_(left) {}

  /// False where the file ends before.
  bool next(QoiCodes& out) {
    if (run_ == 0 && !read()) return false;
    if (run_ > 0) --run_;
    out = last_;
    return true;
  }

 private:
  bool take(int& value) {
    if (left_.empty()) return false;
    value = std::to_integer<int>(left_[0]);
    left_ = left_.subspan(1);
    return true;
  }

  bool read() {
    int head = 0;
    if (!take(head)) return false;
    const auto shift = [&](size_t c, int by) { last_[c] = static_cast<uint8_t>(last_[c] + by); };
    if (head >= 0xFE) {
      for (size_t c = 0; c < (head == 0xFF ? 4U : 3U); ++c) {
        int code = 0;
        if (!take(code)) return false;
        last_[c] = static_cast<uint8_t>(code);
      }
    } else if (head >> 6 == 0) {
      last_ = seen_[static_cast<size_t>(head)];
    } else if (head >> 6 == 1) {
      for (size_t c = 0; c < 3; ++c) shift(c, (head >> (4 - 2 * static_cast<int>(c)) & 3) - 2);
    } else if (head >> 6 == 2) {
      int rest = 0;
      if (!take(rest)) return false;
      const int green = (head & 63) - 32;
      shift(0, green - 8 + (rest >> 4));
      shift(1, green);
      shift(2, green - 8 + (rest & 15));
    } else {
      run_ = (head & 63) + 1;
    }
    seen_[place_of(last_)] = last_;
    return true;
  }

  std::span<const std::byte> left_;
  QoiCodes last_ = {0, 0, 0, 255};
  std::array<QoiCodes, 64> seen_ = {};
  int run_ = 0;
};

}  // namespace

Result<Image> decode_qoi(std::span<const std::byte> file, bool srgb, const ImageLimits& limits) {
  if (file.size() < kHeaderSize) return Error{"the file is truncated"};
  const auto number = [&](size_t at) {
    int64_t value = 0;
    for (size_t i = at; i < at + 4; ++i) value = value << 8 | std::to_integer<int64_t>(file[i]);
    return value;
  };
  const int64_t width = number(4);
  const int64_t height = number(8);
  const int channels = std::to_integer<int>(file[12]);
  const int space = std::to_integer<int>(file[13]);
  if ((channels != 3 && channels != 4) || space > 1) return Error{"the header is damaged"};
  if (const Status size = check_image_size(width, height, channels, limits); !size) {
    return size.error();
  }
  // A byte says 62 pixels at most.
  const uint64_t count = static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  if (file.size() - kHeaderSize < count / 62) return Error{"the file is truncated"};
  QoiPixels pixels(file.subspan(kHeaderSize));
  std::vector<std::string> names = {"R", "G", "B"};
  if (channels == 4) names.emplace_back("A");
  Image image = make_image(static_cast<int>(width), static_cast<int>(height), names);
  const float* linear = linear_of_8_bits(srgb && space == 0);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      QoiCodes codes;
      if (!pixels.next(codes)) {
        return Error{fmt::format("row {} of {} is damaged or missing", y + 1, image.height)};
      }
      for (size_t c = 0; c < 3; ++c) image.at(x, y, static_cast<int>(c)) = linear[codes[c]];
      if (channels == 4) image.at(x, y, 3) = static_cast<float>(codes[3]) / 255.0F;
    }
  }
  return image;
}

}  // namespace hyades::core
