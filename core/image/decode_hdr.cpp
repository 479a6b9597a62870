#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// Radiance pictures (Ward 1994, "The RADIANCE Lighting Simulation and Rendering System"; file
/// format: "Radiance File Formats", chapter 6).
namespace hyades::core {
namespace {

using Rgbe = std::array<uint8_t, 4>;

/// The file from a place on.
struct Cursor {
  std::span<const std::byte> left;

  bool take(uint8_t* out, size_t count) {
    if (left.size() < count) return false;
    std::memcpy(out, left.data(), count);
    left = left.subspan(count);
    return true;
  }

  /// The next line without its end; nothing where there is none within 4096 bytes.
  std::optional<std::string_view> line() {
    const std::string_view text(reinterpret_cast<const char*>(left.data()),
                                std::min<size_t>(left.size(), 4096));
    const size_t end = text.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    left = left.subspan(end + 1);
    std::string_view found = text.substr(0, end);
    if (!found.empty() && found.back() == '\r') found.remove_suffix(1);
    return found;
  }
};

struct HdrHeader {
  int64_t width = 0;
  int64_t height = 0;
  bool bottom_up = false;
  bool right_to_left = false;
  double exposure = 1.0;  ///< product of all EXPOSURE lines: stored = radiance * exposure
};

bool parse_number(std::string_view text, double& value) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end != text.data();
}

/// "-Y 512 +X 1024".
Status parse_resolution(std::string_view text, HdrHeader& header) {
  const Error wrong{
      fmt::format("unknown picture size '{}'; expected '-Y height +X width'", text.substr(0, 60))};
  const auto axis = [&](std::string_view& rest, char& sign, char& name, int64_t& size) {
    while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
    if (rest.size() < 4 || (rest[0] != '+' && rest[0] != '-') || rest[2] != ' ') return false;
    sign = rest[0];
    name = rest[1];
    rest.remove_prefix(3);
    while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), size);
    if (error != std::errc()) return false;
    rest.remove_prefix(static_cast<size_t>(end - rest.data()));
    return true;
  };
  char sign1 = 0, sign2 = 0, name1 = 0, name2 = 0;
  int64_t size1 = 0, size2 = 0;
  if (!axis(text, sign1, name1, size1) || !axis(text, sign2, name2, size2)) return wrong;
  if (name1 == 'X' && name2 == 'Y') return Error{"pictures stored in columns are not read"};
  if (name1 != 'Y' || name2 != 'X') return wrong;
  header.height = size1;
  header.width = size2;
  header.bottom_up = sign1 == '+';
  header.right_to_left = sign2 == '-';
  return {};
}

Result<HdrHeader> parse_header(Cursor& cursor) {
  constexpr std::string_view kFormat = "FORMAT=";
  constexpr std::string_view kExposure = "EXPOSURE=";
  HdrHeader header;
  for (int lines = 0;; ++lines) {
    const auto line = cursor.line();
    if (!line || lines > 1000) return Error{"the header does not end; the file is truncated"};
    if (line->empty()) break;
    if (line->starts_with(kFormat) && line->substr(kFormat.size()) != "32-bit_rle_rgbe") {
      return Error{fmt::format("pixels of format '{}' are not read; expected 32-bit_rle_rgbe",
                               line->substr(kFormat.size(), 40))};
    }
    if (line->starts_with(kExposure)) {
      double factor = 0.0;
      if (!parse_number(line->substr(kExposure.size()), factor) || !(factor > 0.0) ||
          !std::isfinite(factor)) {
        return Error{"EXPOSURE is not a positive number"};
      }
      header.exposure *= factor;
    }
  }
  if (!(header.exposure > 1e-20 && header.exposure < 1e20)) return Error{"absurd EXPOSURE"};
  const auto resolution = cursor.line();
  if (!resolution) return Error{"the header does not end; the file is truncated"};
  if (const Status status = parse_resolution(*resolution, header); !status) return status.error();
  return header;
}

/// A row whose four components follow each other, each run-length coded (since 1991).
bool read_new_row(Cursor& cursor, std::vector<Rgbe>& row) {
  for (size_t component = 0; component < 4; ++component) {
    for (size_t x = 0; x < row.size();) {
      uint8_t count = 0;
      if (!cursor.take(&count, 1)) return false;
      const bool run = count > 128;
      const size_t length = run ? count - 128U : count;
      if (length == 0 || length > row.size() - x) return false;
      uint8_t values[128];
      if (!cursor.take(values, run ? 1 : length)) return false;
      for (size_t i = 0; i < length; ++i) row[x++][component] = values[run ? 0 : i];
    }
  }
  return true;
}

/// A row of plain pixels, where (1, 1, 1, n) repeats the last one n times, and consecutive ones
/// shift n by 8 bits each. `first` has been read already.
bool read_old_row(Cursor& cursor, const Rgbe& first, std::vector<Rgbe>& row) {
  Rgbe pixel = first;
  unsigned shift = 0;
  for (size_t x = 0;;) {
    if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      const size_t count = shift < 32 ? size_t{pixel[3]} << shift : 0;
      if (x == 0 || count > row.size() - x) return false;
      for (size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
      shift += 8;
    } else {
      row[x++] = pixel;
      shift = 0;
    }
    if (x == row.size()) return true;
    if (!cursor.take(pixel.data(), 4)) return false;
  }
}

bool read_row(Cursor& cursor, std::vector<Rgbe>& row) {
  Rgbe first;
  if (!cursor.take(first.data(), 4)) return false;
  const size_t width = row.size();
  const bool is_new = width >= 8 && width < 32768 && first[0] == 2 && first[1] == 2 &&
                      (size_t{first[2]} << 8 | first[3]) == width;
  return is_new ? read_new_row(cursor, row) : read_old_row(cursor, first, row);
}

}  // namespace

Result<Image> decode_hdr(std::span<const std::byte> file, bool srgb, const ImageLimits& limits) {
  Cursor cursor{file};
  const Result<HdrHeader> parsed = parse_header(cursor);
  if (!parsed) return parsed.error();
  const HdrHeader& header = *parsed;
  if (const Status size = check_image_size(header.width, header.height, 3, limits); !size) {
    return size.error();
  }
  // A row takes a pixel and a repetition at least.
  const uint64_t least = static_cast<uint64_t>(header.height) * (header.width > 1 ? 8 : 4);
  if (cursor.left.size() < least) return Error{"the file is truncated"};

  // Powers of two, so scaling is exact; exponents whose numbers would be denormal count as black,
  // as exponent 0 does.
  float scale[256] = {};
  for (int e = 10; e < 256; ++e) {
    scale[e] = static_cast<float>(std::ldexp(1.0, e - 136) / header.exposure);
  }
  const auto width = static_cast<int>(header.width);
  const auto height = static_cast<int>(header.height);
  Image image = make_image(width, height, {"R", "G", "B"});
  std::vector<Rgbe> row(static_cast<size_t>(width));
  for (int line = 0; line < height; ++line) {
    if (!read_row(cursor, row)) {
      return Error{fmt::format("row {} of {} is damaged or missing", line + 1, height)};
    }
    const int y = header.bottom_up ? height - 1 - line : line;
    for (int i = 0; i < width; ++i) {
      const Rgbe& pixel = row[static_cast<size_t>(i)];
      const int x = header.right_to_left ? width - 1 - i : i;
      for (int c = 0; c < 3; ++c) {
        const float value = static_cast<float>(pixel[static_cast<size_t>(c)]) * scale[pixel[3]];
        image.at(x, y, c) = srgb ? srgb_decode(value) : value;
      }
    }
  }
  return image;
}

}  // namespace hyades::core
