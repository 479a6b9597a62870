#include "core/image/read_image.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/assets.h"
#include "core/base/color.h"
#include "core/base/text.h"
#include "core/image/decoders.h"

namespace hyades::core {
namespace {

using Decoder = Result<Image> (*)(std::span<const std::byte>, bool, const ImageLimits&);

struct Format {
  std::string_view magic;  ///< the file's first bytes
  Decoder decode;          ///< nullptr: known, but not read
  const char* name;
  bool display_encoded;  ///< automatic means sRGB
};

constexpr Format kFormats[] = {
    {"\x89PNG\r\n\x1A\n", decode_png, "PNG", true},
    {"\xFF\xD8\xFF", decode_jpeg, "JPEG", true},
    {"#?RADIANCE", decode_hdr, "Radiance HDR", false},
    {"#?RGBE", decode_hdr, "Radiance HDR", false},
    {"v/1\x01", decode_exr, "OpenEXR", false},
    {std::string_view("II+\0", 4), decode_tiff, "TIFF", true},  // with 64-bit offsets
    {std::string_view("MM\0+", 4), decode_tiff, "TIFF", true},
    {"GIF8", nullptr, "GIF", true},
    {"BM", decode_bmp, "BMP", true},
    {"qoif", decode_qoi, "QOI", true},
    {"8BPS", nullptr, "Photoshop", true},
    {std::string_view("II*\0", 4), decode_tiff, "TIFF", true},
    {std::string_view("MM\0*", 4), decode_tiff, "TIFF", true},
    {"RIFF", nullptr, "WebP", true},
    {"DDS ", nullptr, "DDS", true},
    {"PF", decode_pfm, "PFM", false},
    {"Pf", decode_pfm, "PFM", false},
    {"P6", decode_netpbm, "PPM", true},
    {"P5", decode_netpbm, "PGM", true},
    {"IESNA", decode_ies, "IES", false},
    {"IES:LM-63", decode_ies, "IES", false},
};

constexpr Format kTga = {"", decode_tga, "TGA", true};

const Format* format_of(std::span<const std::byte> file) {
  for (const Format& format : kFormats) {
    if (file.size() >= format.magic.size() &&
        std::memcmp(file.data(), format.magic.data(), format.magic.size()) == 0) {
      return &format;
    }
  }
  return looks_like_tga(file) ? &kTga : nullptr;
}

template <size_t N>
std::vector<float> make_table(bool srgb) {
  std::vector<float> table(N);
  for (size_t i = 0; i < N; ++i) {
    const float x = static_cast<float>(i) / static_cast<float>(N - 1);
    table[i] = srgb ? srgb_decode(x) : x;
  }
  // The ends are exact whatever the rounding of the curve.
  table.front() = 0.0F;
  table.back() = 1.0F;
  return table;
}

}  // namespace

Status check_image_size(int64_t width, int64_t height, int64_t channels,
                        const ImageLimits& limits) {
  if (width <= 0 || height <= 0) {
    return Error{fmt::format("empty picture ({} x {} pixels)", width, height)};
  }
  if (width > limits.max_side || height > limits.max_side) {
    return Error{fmt::format("{} x {} pixels; at most {} per side are allowed", width, height,
                             limits.max_side)};
  }
  const auto pixels = static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  if (pixels > limits.max_pixels) {
    return Error{fmt::format("{} x {} pixels; at most {} in all are allowed", width, height,
                             format_count(limits.max_pixels))};
  }
  if (channels > 4 && pixels > uint64_t{limits.max_pixels} * 4 / static_cast<uint64_t>(channels)) {
    return Error{
        fmt::format("{} x {} pixels of {} channels are too much", width, height, channels)};
  }
  return {};
}

void ignore_empty_alpha(Image& image) {
  const size_t count = image.channels.size();
  for (size_t i = count - 1; i < image.data.size(); i += count) {
    if (image.data[i] != 0.0F) return;
  }
  for (size_t i = count - 1; i < image.data.size(); i += count) image.data[i] = 1.0F;
}

const float* linear_of_8_bits(bool srgb) {
  static const std::vector<float> decoded = make_table<256>(true);
  static const std::vector<float> plain = make_table<256>(false);
  return srgb ? decoded.data() : plain.data();
}

const float* linear_of_16_bits(bool srgb) {
  static const std::vector<float> decoded = make_table<65536>(true);
  static const std::vector<float> plain = make_table<65536>(false);
  return srgb ? decoded.data() : plain.data();
}

Result<Image> read_image(const Bytes& bytes, const std::string& name, ColorSpace space,
                         const ImageLimits& limits) {
  const std::span<const std::byte> file = bytes.span();
  if (file.empty()) return Error{name + ": the file is empty"};
  const Format* format = format_of(file);
  constexpr const char* kExpected =
      "expected PNG, JPEG, TIFF, TGA, BMP, QOI, PPM, PFM, Radiance HDR, OpenEXR or IES";
  if (format == nullptr) return Error{fmt::format("{}: not a known picture; {}", name, kExpected)};
  if (format->decode == nullptr) {
    return Error{fmt::format("{}: {} files are not read; {}", name, format->name, kExpected)};
  }
  const bool encoded =
      format->display_encoded && !(format->decode == decode_tiff && tiff_holds_floats(file));
  const bool srgb = space == ColorSpace::srgb || (space == ColorSpace::automatic && encoded);
  try {
    Result<Image> image = format->decode(file, srgb, limits);
    if (!image) return image.error().in(std::string(format->name)).in(name);
    return image;
  } catch (const std::bad_alloc&) {
    return Error{name + ": not enough memory for this picture"};
  }
}

Result<Image> read_image_file(const std::string& path, ColorSpace space) {
  const Result<Bytes> bytes = map_file(path);
  if (!bytes) return bytes.error().in(path);
  return read_image(*bytes, path, space);
}

}  // namespace hyades::core
