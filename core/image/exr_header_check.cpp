#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>

#include "core/image/exr_support.h"

namespace hyades::core {
namespace {

constexpr size_t kLongestName = 255;
constexpr int kMaxParts = 1000;
constexpr int kMaxAttributes = 100'000;  // of all parts

/// Reads the header's little-endian fields.
struct HeaderCursor {
  std::span<const std::byte> left;

  std::optional<std::string_view> name() {
    const std::string_view text(reinterpret_cast<const char*>(left.data()),
                                std::min(left.size(), kLongestName + 1));
    const size_t end = text.find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    left = left.subspan(end + 1);
    return text.substr(0, end);
  }

  std::optional<int32_t> number() {
    if (left.size() < 4) return std::nullopt;
    int32_t value;
    std::memcpy(&value, left.data(), 4);
    left = left.subspan(4);
    return value;
  }
};

/// What decides how much memory a part takes.
struct Part {
  int64_t width = 0;
  int64_t height = 0;
  int64_t channels = 0;
  int64_t tile_width = 0;  ///< 0: scan lines
  int64_t tile_height = 0;
};

/// How many channels a list has; nothing where it does not end with its value.
std::optional<int64_t> count_channels(std::span<const std::byte> value) {
  // Each: a name, then 16 bytes; the list ends with an empty name.
  HeaderCursor cursor{value};
  int64_t count = 0;
  auto name = cursor.name();
  for (; name && !name->empty(); name = cursor.name()) {
    if (cursor.left.size() < 16) return std::nullopt;
    cursor.left = cursor.left.subspan(16);
    ++count;
  }
  if (!name || !cursor.left.empty()) return std::nullopt;
  return count;
}

/// Whether a list of texts, each behind its length, ends with its value.
bool is_string_vector(std::span<const std::byte> value) {
  HeaderCursor cursor{value};
  while (!cursor.left.empty()) {
    const auto length = cursor.number();
    if (!length || *length < 0 || static_cast<size_t>(*length) > cursor.left.size()) return false;
    cursor.left = cursor.left.subspan(static_cast<size_t>(*length));
  }
  return true;
}

/// A width, a height and four bytes for each pixel.
bool is_preview(std::span<const std::byte> value) {
  HeaderCursor cursor{value};
  const auto width = cursor.number();
  const auto height = cursor.number();
  return width && height && *width >= 0 && *height >= 0 &&
         uint64_t{static_cast<uint32_t>(*width)} * static_cast<uint32_t>(*height) * 4 ==
             cursor.left.size();
}

struct FixedSize {
  std::string_view type;
  size_t bytes;
};

/// OpenEXR File Layout, "Predefined Attribute Types".
constexpr FixedSize kFixedSizes[] = {
    {"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"lineOrder", 1},   {"m33f", 36},    {"m33d", 72},
    {"m44f", 64},       {"m44d", 128},   {"rational", 8},
    {"tiledesc", 9},    {"timecode", 8}, {"v2i", 8},
    {"v2f", 8},         {"v2d", 16},     {"v3i", 12},
    {"v3f", 12},        {"v3d", 24},     {"deepImageState", 1},
};

/// Whether a value is as long as its type says. OpenEXR does not look at the length of most: it
/// would go on in the midst of another attribute, and believe whatever length it finds there.
bool ends_where_it_should(std::string_view type, std::span<const std::byte> value) {
  if (type == "chlist") return count_channels(value).has_value();
  if (type == "stringvector") return is_string_vector(value);
  if (type == "preview") return is_preview(value);
  if (type == "floatvector") return value.size() % 4 == 0;
  const auto* const fixed = std::find_if(std::begin(kFixedSizes), std::end(kFixedSizes),
                                         [&](const FixedSize& row) { return row.type == type; });
  return fixed == std::end(kFixedSizes) || value.size() == fixed->bytes;
}

/// Of a value that ends where it should.
void note(std::string_view name, std::string_view type, std::span<const std::byte> value,
          Part& part) {
  HeaderCursor cursor{value};
  if (name == "dataWindow" && type == "box2i") {
    const int64_t x0 = *cursor.number();
    const int64_t y0 = *cursor.number();
    part.width = *cursor.number() - x0 + 1;
    part.height = *cursor.number() - y0 + 1;
  } else if (name == "tiles" && type == "tiledesc") {
    // Sizes are unsigned; those above 2^31 show up as negative.
    part.tile_width = *cursor.number();
    part.tile_height = *cursor.number();
  } else if (name == "channels" && type == "chlist") {
    part.channels = *count_channels(value);
  }
}

Status check_part(const Part& part, size_t file_size, const ImageLimits& limits) {
  if (Status size = check_image_size(part.width, part.height, part.channels, limits); !size) {
    return size;
  }
  int64_t chunks = part.height / 256;  // the tallest chunk of all compressions, for scan lines
  if (part.tile_width != 0 || part.tile_height != 0) {
    if (part.tile_width <= 0 || part.tile_height <= 0) return Error{"tiles of no size"};
    chunks = ((part.width - 1) / part.tile_width + 1) * ((part.height - 1) / part.tile_height + 1);
  }
  // Each chunk has an entry of 8 bytes in the table of offsets and a head of 8 bytes.
  if (static_cast<uint64_t>(chunks) * 16 > file_size) return Error{"the file is truncated"};
  return {};
}

}  // namespace

Status check_exr_header(std::span<const std::byte> file, const ImageLimits& limits) {
  const Error truncated{"the file is truncated"};
  HeaderCursor cursor{file};
  cursor.number();  // the magic number
  const auto version = cursor.number();
  if (!version) return truncated;
  const bool multi_part = (*version & 0x1000) != 0;
  int attributes = 0;
  for (int parts = 0; parts < kMaxParts; ++parts) {
    Part part;
    bool any = false;
    for (;;) {
      const auto name = cursor.name();
      if (!name) return truncated;
      if (name->empty()) break;
      any = true;
      const auto type = cursor.name();
      const auto size = cursor.number();
      if (!type || !size) return truncated;
      if (*size < 0 || static_cast<size_t>(*size) > cursor.left.size()) {
        return Error{fmt::format("attribute '{}' is longer than the file", *name)};
      }
      if (++attributes > kMaxAttributes) return Error{"too many attributes"};
      const auto value = cursor.left.first(static_cast<size_t>(*size));
      if (!ends_where_it_should(*type, value)) {
        return Error{
            fmt::format("attribute '{}' has {} bytes, which is no {}", *name, *size, *type)};
      }
      note(*name, *type, value, part);
      cursor.left = cursor.left.subspan(static_cast<size_t>(*size));
    }
    if (multi_part && !any) {
      return parts > 0 ? Status() : Status(Error{"the file has no parts"});
    }
    if (Status status = check_part(part, file.size(), limits); !status) return status;
    if (!multi_part) return {};
  }
  return Error{"too many parts"};
}

}  // namespace hyades::core
