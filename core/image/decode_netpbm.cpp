#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/color.h"
#include "core/image/decoders.h"

/// The binary pictures of Netpbm (P5 and P6, 8 or 16 bits: its manual pages pgm and ppm) and their
/// floating-point kin PFM (Pf and PF, Debevec).
namespace hyades::core {
namespace {

struct NetpbmHeader {
  int channels = 0;
  int64_t width = 0;
  int64_t height = 0;
  double last = 0.0;  ///< the largest code, or the scale of PFM, below 0 for little-endian
  std::span<const std::byte> pixels;
};

bool is_space(std::byte byte) {
  const auto c = std::to_integer<char>(byte);
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
}

/// The next word of a header, past white space and comments; nothing where there is none.
std::optional<std::string_view> next_word(std::span<const std::byte>& left) {
  size_t begin = 0;
  while (begin < left.size() && (is_space(left[begin]) || left[begin] == std::byte{'#'})) {
    if (left[begin] == std::byte{'#'}) {
      while (begin < left.size() && left[begin] != std::byte{'\n'}) ++begin;
    } else {
      ++begin;
    }
  }
  size_t end = begin;
  while (end < left.size() && end - begin < 64 && !is_space(left[end])) ++end;
  if (end == begin || end == left.size() || !is_space(left[end])) return std::nullopt;
  const std::string_view word(reinterpret_cast<const char*>(left.data()) + begin, end - begin);
  left = left.subspan(end);
  return word;
}

template <class T>
bool parse(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

Result<NetpbmHeader> parse_header(std::span<const std::byte> file) {
  NetpbmHeader header;
  header.channels = file[1] == std::byte{'6'} || file[1] == std::byte{'F'} ? 3 : 1;
  header.pixels = file.subspan(2);
  const auto width = next_word(header.pixels);
  const auto height = width ? next_word(header.pixels) : std::nullopt;
  const auto last = height ? next_word(header.pixels) : std::nullopt;
  if (!last) return Error{"the header is truncated"};
  if (!parse(*width, header.width) || !parse(*height, header.height) ||
      !parse(*last, header.last) || !std::isfinite(header.last)) {
    return Error{"the header is damaged; expected width, height and a number"};
  }
  // One character of white space stands between header and pixels.
  header.pixels = header.pixels.subspan(1);
  return header;
}

Image image_for(const NetpbmHeader& header) {
  return make_image(static_cast<int>(header.width), static_cast<int>(header.height),
                    header.channels == 3 ? std::vector<std::string>{"R", "G", "B"}
                                         : std::vector<std::string>{"Y"});
}

}  // namespace

Result<Image> decode_netpbm(std::span<const std::byte> file, bool srgb, const ImageLimits& limits) {
  const Result<NetpbmHeader> header = parse_header(file);
  if (!header) return header.error();
  if (!(header->last >= 1.0 && header->last <= 65535.0) ||
      header->last != std::floor(header->last)) {
    return Error{"the largest code is not between 1 and 65535"};
  }
  if (const Status size = check_image_size(header->width, header->height, header->channels, limits);
      !size) {
    return size.error();
  }
  const size_t size = header->last > 255.0 ? 2 : 1;
  const size_t count = static_cast<size_t>(header->width) * static_cast<size_t>(header->height) *
                       static_cast<size_t>(header->channels);
  if (header->pixels.size() / size < count) return Error{"the file is truncated"};
  Image image = image_for(*header);
  for (size_t i = 0; i < count; ++i) {
    auto code = std::to_integer<unsigned>(header->pixels[i * size]);
    if (size == 2) code = code << 8 | std::to_integer<unsigned>(header->pixels[i * size + 1]);
    const auto value = static_cast<float>(std::min(code / header->last, 1.0));
    image.data[i] = srgb ? srgb_decode(value) : value;
  }
  return image;
}

Result<Image> decode_pfm(std::span<const std::byte> file, bool srgb, const ImageLimits& limits) {
  const Result<NetpbmHeader> header = parse_header(file);
  if (!header) return header.error();
  if (header->last == 0.0) return Error{"the scale is 0"};
  if (const Status size = check_image_size(header->width, header->height, header->channels, limits);
      !size) {
    return size.error();
  }
  const size_t row_size =
      static_cast<size_t>(header->width) * static_cast<size_t>(header->channels);
  if (header->pixels.size() / 4 / row_size < static_cast<size_t>(header->height)) {
    return Error{"the file is truncated"};
  }
  const bool swap = (header->last < 0.0) != (std::endian::native == std::endian::little);
  const auto scale = static_cast<float>(std::abs(header->last));
  Image image = image_for(*header);
  const std::byte* at = header->pixels.data();
  for (int64_t y = header->height - 1; y >= 0; --y) {  // the lowest row first
    float* out = &image.data[static_cast<size_t>(y) * row_size];
    for (size_t i = 0; i < row_size; ++i, at += 4) {
      uint32_t bits = 0;
      std::memcpy(&bits, at, sizeof(bits));
      if (swap) bits = __builtin_bswap32(bits);
      const float value = std::bit_cast<float>(bits) * scale;
      out[i] = srgb ? srgb_decode(value) : value;
    }
  }
  return image;
}

}  // namespace hyades::core
