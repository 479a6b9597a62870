// jpeglib.h needs size_t and FILE before it.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>

#include <jerror.h>
#include <jpeglib.h>

#include <csetjmp>
#include <string>
#include <vector>

#include "core/image/decoders.h"

namespace hyades::core {
namespace {

// A progressive file may repeat tiny scans over a large picture for ever; real ones have about ten.
constexpr int kMaxScans = 200;

/// All state of one decoding. libjpeg reports errors through error_exit, which longjmps; no C++
/// object lives in the functions that it passes over.
struct JpegReader {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX] = "";
  bool created = false;

  ~JpegReader() {
    if (created) jpeg_destroy_decompress(&jpeg);
  }
};

JpegReader& reader_of(j_common_ptr info) { return *static_cast<JpegReader*>(info->client_data); }

[[noreturn]] void on_error(j_common_ptr info) {
  JpegReader& reader = reader_of(info);
  info->err->format_message(info, reader.message);
  std::longjmp(reader.jump, 1);
}

/// libjpeg paints over damage and warns; we would rather know.
void on_message(j_common_ptr info, int level) {
  if (level >= 0) return;
  switch (info->err->msg_code) {
    case JWRN_JPEG_EOF:
    case JWRN_HIT_MARKER:
    case JWRN_HUFF_BAD_CODE:
    case JWRN_NOT_SEQUENTIAL:
      on_error(info);
    default:
      return;
  }
}

void on_progress(j_common_ptr info) {
  auto* jpeg = reinterpret_cast<j_decompress_ptr>(info);
  if (jpeg->input_scan_number > kMaxScans) ERREXIT(jpeg, JERR_BAD_PROGRESSION);
}

bool read_header(JpegReader& reader, std::span<const std::byte> file) {
  if (setjmp(reader.jump) != 0) return false;
  jpeg_create_decompress(&reader.jpeg);
  reader.created = true;
  reader.jpeg.client_data = &reader;
  reader.jpeg.progress = &reader.progress;
  jpeg_mem_src(&reader.jpeg, reinterpret_cast<const unsigned char*>(file.data()), file.size());
  jpeg_read_header(&reader.jpeg, TRUE);
  return true;
}

bool read_rows(JpegReader& reader, Image& image, std::vector<JSAMPLE>& row, const float* table) {
  if (setjmp(reader.jump) != 0) return false;
  reader.jpeg.dct_method = JDCT_ISLOW;  // the exact one, the same with and without SIMD
  jpeg_start_decompress(&reader.jpeg);
  while (reader.jpeg.output_scanline < reader.jpeg.output_height) {
    const auto y = static_cast<int>(reader.jpeg.output_scanline);
    JSAMPROW rows[] = {row.data()};
    jpeg_read_scanlines(&reader.jpeg, rows, 1);
    float* out = &image.data[image.index(0, y, 0)];
    for (size_t i = 0; i < row.size(); ++i) out[i] = table[row[i]];
  }
  jpeg_finish_decompress(&reader.jpeg);
  return true;
}

}  // namespace

Result<Image> decode_jpeg(std::span<const std::byte> file, bool srgb, const ImageLimits& limits) {
  JpegReader reader;
  reader.jpeg.err = jpeg_std_error(&reader.errors);
  reader.errors.error_exit = on_error;
  reader.errors.emit_message = on_message;
  reader.progress.progress_monitor = on_progress;
  reader.jpeg.client_data = &reader;
  if (!read_header(reader, file)) return Error{reader.message};

  const int64_t width = reader.jpeg.image_width;
  const int64_t height = reader.jpeg.image_height;
  if (const Status size = check_image_size(width, height, 4, limits); !size) return size.error();
  // A Huffman-coded block of 8x8 pixels takes one bit at the very least.
  if (reader.jpeg.arith_code == FALSE &&
      static_cast<uint64_t>(width) * static_cast<uint64_t>(height) / 512 > file.size()) {
    return Error{"the file is truncated"};
  }
  bool grey = false;
  switch (reader.jpeg.jpeg_color_space) {
    case JCS_GRAYSCALE:
      grey = true;
      break;
    case JCS_RGB:
    case JCS_YCbCr:
      break;
    case JCS_CMYK:
    case JCS_YCCK:
      return Error{"CMYK colours (for printing) are not read; save it as RGB"};
    default:
      return Error{"unknown colour space; expected grey or RGB"};
  }
  reader.jpeg.out_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
  Image image =
      make_image(static_cast<int>(width), static_cast<int>(height),
                 grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"});
  std::vector<JSAMPLE> row(static_cast<size_t>(width) * image.channels.size());
  if (!read_rows(reader, image, row, linear_of_8_bits(srgb))) return Error{reader.message};
  return image;
}

}  // namespace hyades::core
