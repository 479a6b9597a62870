#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/color.h"
#include "core/image/decoders.h"

namespace hyades::core {
namespace {

/// Deflate and LZW make at most some thousand bytes of one.
constexpr uint64_t kMostPacked = 4096;

/// A file in memory, as libtiff reads files.
struct Source {
  std::span<const std::byte> file;
  uint64_t at = 0;
  std::string message;  ///< libtiff's last complaint
};

Source& source_of(thandle_t handle) { return *static_cast<Source*>(handle); }

tmsize_t on_read(thandle_t handle, void* out, tmsize_t count) {
  Source& source = source_of(handle);
  const uint64_t left = source.at < source.file.size() ? source.file.size() - source.at : 0;
  const uint64_t taken = std::min(left, static_cast<uint64_t>(std::max<tmsize_t>(count, 0)));
  if (taken > 0) std::memcpy(out, source.file.data() + source.at, taken);
  source.at += taken;
  return static_cast<tmsize_t>(taken);
}

tmsize_t on_write(thandle_t, void*, tmsize_t) { return 0; }

toff_t on_seek(thandle_t handle, toff_t offset, int whence) {
  Source& source = source_of(handle);
  const uint64_t base = whence == SEEK_CUR   ? source.at
                        : whence == SEEK_END ? source.file.size()
                                             : 0;
  source.at = base + offset;
  return source.at;
}

int on_close(thandle_t) { return 0; }

toff_t on_size(thandle_t handle) { return source_of(handle).file.size(); }

int on_map(thandle_t, void**, toff_t*) { return 0; }

void on_unmap(thandle_t, void*, toff_t) {}

int on_error(TIFF*, void* user_data, const char*, const char* format, va_list arguments) {
  auto& message = *static_cast<std::string*>(user_data);
  char text[256] = "";
  std::vsnprintf(text, sizeof(text), format, arguments);
  message = text;
  return 1;
}

int on_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

using Handle = std::unique_ptr<TIFF, void (*)(TIFF*)>;

Handle open_tiff(Source& source) {
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, &source.message);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_warning, nullptr);
  // "m": nothing is mapped.
  return {TIFFClientOpenExt("", "rm", &source, on_read, on_write, on_seek, on_close, on_size,
                            on_map, on_unmap, options.get()),
          TIFFClose};
}

/// What the file says of its pixels.
struct Shape {
  uint32_t width = 0;
  uint32_t height = 0;
  uint16_t bits = 1;
  uint16_t channels = 1;
  uint16_t format = SAMPLEFORMAT_UINT;
  uint16_t photometric = PHOTOMETRIC_MINISBLACK;
  uint16_t planes = PLANARCONFIG_CONTIG;
  uint16_t orientation = ORIENTATION_TOPLEFT;
  bool premultiplied = false;  ///< colours by alpha
};

Shape shape_of(TIFF* tiff) {
  Shape shape;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &shape.width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &shape.height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &shape.bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &shape.channels);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &shape.format);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &shape.photometric);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &shape.planes);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &shape.orientation);
  uint16_t extra = 0;
  uint16_t* kinds = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &extra, &kinds) == 1 && extra == 1)
    shape.premultiplied = kinds[0] == EXTRASAMPLE_ASSOCALPHA;
  return shape;
}

bool is_float(const Shape& shape) {
  return shape.bits == 32 && shape.format == SAMPLEFORMAT_IEEEFP;
}

Status check_shape(const Shape& shape, const ImageLimits& limits) {
  if (const Status size = check_image_size(shape.width, shape.height, 4, limits); !size)
    return size;
  const bool codes = shape.format == SAMPLEFORMAT_UINT && (shape.bits == 8 || shape.bits == 16);
  if (!codes && !is_float(shape)) {
    return Error{
        fmt::format("{} bits per sample of kind {}; expected 8 or 16 bits of whole numbers "
                    "or 32 of floating point",
                    shape.bits, shape.format)};
  }
  const bool grey = shape.photometric == PHOTOMETRIC_MINISBLACK;
  if (!grey && shape.photometric != PHOTOMETRIC_RGB) {
    return Error{fmt::format("photometric interpretation {}; expected grey (1) or RGB (2)",
                             shape.photometric)};
  }
  const int color = grey ? 1 : 3;
  if (shape.channels != color && shape.channels != color + 1) {
    return Error{
        fmt::format("{} samples per pixel; expected {} or {}", shape.channels, color, color + 1)};
  }
  if (shape.planes != PLANARCONFIG_CONTIG)
    return Error{"channels in planes of their own are not read"};
  if (shape.orientation != ORIENTATION_TOPLEFT)
    return Error{"rows that do not go from the upper left corner are not read"};
  return {};
}

/// Puts rows of codes, or parts of them, into a picture.
class Sink {
 public:
  Sink(Image& image, const Shape& shape, bool srgb) : image_(image), shape_(shape), srgb_(srgb) {}

  size_t pixel_bytes() const { return shape_.channels * sample_bytes(); }

  void store(const uint8_t* codes, uint32_t x, uint32_t y, uint32_t pixels) {
    float* out = &image_.data[image_.index(static_cast<int>(x), static_cast<int>(y), 0)];
    const bool has_alpha = shape_.channels % 2 == 0;
    const size_t colors = shape_.channels - (has_alpha ? 1U : 0U);
    for (uint32_t i = 0; i < pixels; ++i) {
      const float alpha = has_alpha ? number(codes + colors * sample_bytes()) : 1.0F;
      if (has_alpha) out[colors] = alpha;
      for (size_t c = 0; c < colors; ++c) {
        const uint8_t* code = codes + c * sample_bytes();
        // Straight from here on. The codes were multiplied, not the light that they stand for.
        out[c] = shape_.premultiplied ? decoded(alpha > 0.0F ? number(code) / alpha : 0.0F)
                                      : light(code);
      }
      out += shape_.channels;
      codes += pixel_bytes();
    }
  }

 private:
  size_t sample_bytes() const { return shape_.bits / 8U; }

  float decoded(float value) const { return srgb_ ? srgb_decode(value) : value; }

  float number(const uint8_t* code) const { return as_float(code, false); }

  float light(const uint8_t* code) const {
    return shape_.bits == 32 ? decoded(as_float(code, false)) : as_float(code, srgb_);
  }

  float as_float(const uint8_t* code, bool srgb) const {
    if (shape_.bits == 8) return linear_of_8_bits(srgb)[*code];
    if (shape_.bits == 16) {
      uint16_t number;
      std::memcpy(&number, code, sizeof(number));
      return linear_of_16_bits(srgb)[number];
    }
    float number;
    std::memcpy(&number, code, sizeof(number));
    return number;
  }

  Image& image_;
  const Shape& shape_;
  bool srgb_;
};

bool read_rows(TIFF* tiff, const Shape& shape, Sink& sink) {
  const auto bytes = static_cast<size_t>(std::max<tmsize_t>(TIFFScanlineSize(tiff), 0));
  if (bytes < sink.pixel_bytes() * shape.width) return false;
  std::vector<uint8_t> row(bytes);
  for (uint32_t y = 0; y < shape.height; ++y) {
    if (TIFFReadScanline(tiff, row.data(), y) != 1) return false;
    sink.store(row.data(), 0, y, shape.width);
  }
  return true;
}

bool read_tiles(TIFF* tiff, const Shape& shape, Sink& sink) {
  uint32_t width = 0;
  uint32_t height = 0;
  TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_TILELENGTH, &height);
  const auto bytes = static_cast<size_t>(std::max<tmsize_t>(TIFFTileSize(tiff), 0));
  const uint64_t needed = uint64_t{width} * height * sink.pixel_bytes();
  const uint64_t all = uint64_t{shape.width} * shape.height * sink.pixel_bytes();
  // Tiles reach beyond the picture's edge, but are no pictures of their own.
  if (width == 0 || height == 0 || bytes < needed || bytes > 16 * all + (uint64_t{1} << 24U))
    return false;
  std::vector<uint8_t> tile(bytes);
  for (uint32_t y = 0; y < shape.height; y += height) {
    for (uint32_t x = 0; x < shape.width; x += width) {
      if (TIFFReadTile(tiff, tile.data(), x, y, 0, 0) < 0) return false;
      const uint32_t columns = std::min(width, shape.width - x);
      const uint32_t rows = std::min(height, shape.height - y);
      for (uint32_t row = 0; row < rows; ++row)
        sink.store(tile.data() + size_t{row} * width * sink.pixel_bytes(), x, y + row, columns);
    }
  }
  return true;
}

}  // namespace

bool tiff_holds_floats(std::span<const std::byte> file) {
  Source source{file, 0, {}};
  const Handle tiff = open_tiff(source);
  return tiff && is_float(shape_of(tiff.get()));
}

Result<Image> decode_tiff(std::span<const std::byte> file, bool srgb, const ImageLimits& limits) {
  Source source{file, 0, {}};
  const Handle tiff = open_tiff(source);
  const auto failed = [&source] {
    return Error{source.message.empty() ? "the file is damaged" : source.message};
  };
  if (!tiff) return failed();
  const Shape shape = shape_of(tiff.get());
  if (const Status good = check_shape(shape, limits); !good) return good.error();
  const uint64_t pixels = uint64_t{shape.width} * shape.height;
  if (pixels * shape.channels * (shape.bits / 8U) / kMostPacked > file.size())
    return Error{"the file is truncated, or packed more than anybody's pictures are"};
  std::vector<std::string> names = {"Y", "A"};
  if (shape.channels > 2) names = {"R", "G", "B", "A"};
  names.resize(shape.channels);
  Image image =
      make_image(static_cast<int>(shape.width), static_cast<int>(shape.height), std::move(names));
  Sink sink(image, shape, srgb);
  const bool tiled = TIFFIsTiled(tiff.get()) != 0;
  if (!(tiled ? read_tiles(tiff.get(), shape, sink) : read_rows(tiff.get(), shape, sink)))
    return failed();
  return image;
}

}  // namespace hyades::core
