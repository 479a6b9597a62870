#include <png.h>

#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/image/decoders.h"

namespace hyades::core {
namespace {

/// All state of one decoding. libpng reports errors by longjmp, which must not pass over living C++
/// objects: they live here, outside the functions that call setjmp.
struct PngReader {
  std::span<const std::byte> file;
  size_t at = 0;
  char message[256] = "";
  png_structp png = nullptr;
  png_infop info = nullptr;
  int passes = 1;
  std::vector<png_byte> rows;  ///< one row; all of them where the file is interlaced

  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void on_png_read_error(png_structp png, png_const_charp message) {
  auto* reader = static_cast<PngReader*>(png_get_error_ptr(png));
  std::strncpy(reader->message, message, sizeof(reader->message) - 1);
  png_longjmp(png, 1);
}

void on_png_read_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep out, size_t count) {
  auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
  if (count > reader->file.size() - reader->at) png_error(png, "the file is truncated");
  std::memcpy(out, reader->file.data() + reader->at, count);
  reader->at += count;
}

bool read_header(PngReader& reader) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_read_fn(reader.png, &reader, on_read);
  // Our own limits are checked as soon as the size is known.
  png_set_user_limits(reader.png, 0x7FFFFFFFU, 0x7FFFFFFFU);
  // Only what decides the pixels is read; no chunk can be longer than the file.
  png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_set_chunk_malloc_max(reader.png, reader.file.size());
  png_read_info(reader.png, reader.info);
  return true;
}

/// Asks for 8 or 16 bits of grey, grey + alpha, RGB or RGBA, and for whole rows.
bool set_up_rows(PngReader& reader) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_expand(reader.png);  // palettes, 1-4 bits of grey, transparent colours
  png_set_swap(reader.png);    // 16 bits in the order of this machine
  reader.passes = png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

/// What a row of decoded codes becomes.
struct RowSink {
  Image* image;
  int bits;
  const float* color;  ///< tables of linear_of_N_bits
  const float* alpha;
};

void store_row(const RowSink& sink, const png_byte* row, int y) noexcept {
  Image& image = *sink.image;
  const size_t channels = image.channels.size();
  const bool has_alpha = channels == 2 || channels == 4;
  float* out = &image.data[image.index(0, y, 0)];
  const size_t values = static_cast<size_t>(image.width) * channels;
  for (size_t i = 0; i < values; ++i) {
    const float* table = has_alpha && i % channels == channels - 1 ? sink.alpha : sink.color;
    if (sink.bits == 16) {
      uint16_t code;
      std::memcpy(&code, row + 2 * i, 2);
      out[i] = table[code];
    } else {
      out[i] = table[row[i]];
    }
  }
}

bool read_rows(PngReader& reader, const RowSink& sink, size_t row_bytes) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  const int height = sink.image->height;
  for (int pass = 0; pass < reader.passes; ++pass) {
    for (int y = 0; y < height; ++y) {
      const size_t row = reader.passes > 1 ? static_cast<size_t>(y) : 0;
      png_bytep codes = reader.rows.data() + row * row_bytes;
      png_read_row(reader.png, codes, nullptr);
      if (pass + 1 == reader.passes) store_row(sink, codes, y);
    }
  }
  png_read_end(reader.png, nullptr);
  return true;
}

}  // namespace

Result<Image> decode_png(std::span<const std::byte> file, bool srgb, const ImageLimits& limits) {
  PngReader reader;
  reader.file = file;
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_png_read_error,
                                      on_png_read_warning);
  if (reader.png != nullptr) reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) return Error{"not enough memory"};
  if (!read_header(reader)) return Error{reader.message};

  const int64_t width = png_get_image_width(reader.png, reader.info);
  const int64_t height = png_get_image_height(reader.png, reader.info);
  if (const Status size = check_image_size(width, height, 4, limits); !size) return size.error();
  // Deflate makes at most 1032 bytes of one: a small file cannot hold a large picture.
  const uint64_t packed_bytes =
      uint64_t{png_get_rowbytes(reader.png, reader.info)} * static_cast<uint64_t>(height);
  if (packed_bytes / 1040 > file.size()) return Error{"the file is truncated"};
  if (!set_up_rows(reader)) return Error{reader.message};

  const int channels = png_get_channels(reader.png, reader.info);
  std::vector<std::string> names;
  switch (channels) {
    case 1:
      names = {"Y"};
      break;
    case 2:
      names = {"Y", "A"};
      break;
    case 3:
      names = {"R", "G", "B"};
      break;
    case 4:
      names = {"R", "G", "B", "A"};
      break;
    default:
      return Error{"unknown kind of pixels"};
  }
  Image image = make_image(static_cast<int>(width), static_cast<int>(height), std::move(names));
  const size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  reader.rows.resize(reader.passes > 1 ? row_bytes * static_cast<size_t>(height) : row_bytes);
  const int bits = png_get_bit_depth(reader.png, reader.info);
  const RowSink sink{&image, bits, bits == 16 ? linear_of_16_bits(srgb) : linear_of_8_bits(srgb),
                     bits == 16 ? linear_of_16_bits(false) : linear_of_8_bits(false)};
  if (!read_rows(reader, sink, row_bytes)) return Error{reader.message};
  return image;
}

}  // namespace hyades::core
