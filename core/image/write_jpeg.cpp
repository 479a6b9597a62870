// jpeglib.h needs size_t and FILE before it.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>

#include <jpeglib.h>

#include <algorithm>
#include <csetjmp>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/image/encode_codes.h"
#include "core/image/write_image.h"

namespace hyades::core {
namespace {

constexpr size_t kLongestComment = 65533;  ///< bytes of a marker

/// All state of one encoding; see decode_jpeg.cpp about longjmp.
struct JpegWriter {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX] = "";
  unsigned char* file = nullptr;  ///< allocated by libjpeg
  unsigned long size = 0;
  bool created = false;

  ~JpegWriter() {
    if (created) jpeg_destroy_compress(&jpeg);
    std::free(file);
  }
};

[[noreturn]] void on_jpeg_error(j_common_ptr info) {
  auto& writer = *static_cast<JpegWriter*>(info->client_data);
  info->err->format_message(info, writer.message);
  std::longjmp(writer.jump, 1);
}

/// What stands in the file beside the picture: one comment, and what the colours mean.
struct Said {
  std::string comment;
  std::vector<uint8_t> profile;
};

bool encode(JpegWriter& writer, const Codes& codes, int width, int height, int quality,
            const Said& said) {
  if (setjmp(writer.jump) != 0) return false;
  jpeg_create_compress(&writer.jpeg);
  writer.created = true;
  writer.jpeg.client_data = &writer;
  jpeg_mem_dest(&writer.jpeg, &writer.file, &writer.size);
  writer.jpeg.image_width = static_cast<JDIMENSION>(width);
  writer.jpeg.image_height = static_cast<JDIMENSION>(height);
  writer.jpeg.input_components = codes.channels;
  writer.jpeg.in_color_space = codes.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&writer.jpeg);
  jpeg_set_quality(&writer.jpeg, quality, TRUE);
  if (quality >= 90) {
    // Full colour resolution: renders have sharp coloured edges.
    writer.jpeg.comp_info[0].h_samp_factor = 1;
    writer.jpeg.comp_info[0].v_samp_factor = 1;
  }
  writer.jpeg.optimize_coding = TRUE;
  jpeg_start_compress(&writer.jpeg, TRUE);
  if (!said.comment.empty()) {
    jpeg_write_marker(&writer.jpeg, JPEG_COM, reinterpret_cast<const JOCTET*>(said.comment.data()),
                      static_cast<unsigned>(said.comment.size()));
  }
  if (!said.profile.empty()) {
    jpeg_write_icc_profile(&writer.jpeg, said.profile.data(),
                           static_cast<unsigned>(said.profile.size()));
  }
  const size_t row_bytes = static_cast<size_t>(width) * static_cast<size_t>(codes.channels);
  while (writer.jpeg.next_scanline < writer.jpeg.image_height) {
    JSAMPROW rows[] = {
        const_cast<JSAMPLE*>(codes.data.data() + size_t{writer.jpeg.next_scanline} * row_bytes)};
    jpeg_write_scanlines(&writer.jpeg, rows, 1);
  }
  jpeg_finish_compress(&writer.jpeg);
  return true;
}

}  // namespace

Status write_jpeg(const std::string& path, const Image& image, int quality,
                  const ImageMetadata& metadata, ColorTag color) {
  const std::string context = "cannot write " + path;
  const Result<Codes> codes = encode_codes(image, false);
  if (!codes) return codes.error().in(context);
  JpegWriter writer;
  writer.jpeg.err = jpeg_std_error(&writer.errors);
  writer.errors.error_exit = on_jpeg_error;
  writer.jpeg.client_data = &writer;
  const Said said{metadata_lines(metadata).substr(0, kLongestComment), icc_profile(color)};
  if (!encode(writer, *codes, image.width, image.height, std::clamp(quality, 1, 100), said)) {
    return Error{context + ": " + writer.message};
  }
  return write_file(path, std::as_bytes(std::span(writer.file, writer.size)));
}

}  // namespace hyades::core
