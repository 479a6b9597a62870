#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/image/encode_codes.h"
#include "core/image/write_image.h"

namespace hyades::core {
namespace {

/// All state of one encoding: libpng's longjmp must not pass over living C++ objects.
struct PngWriter {
  png_structp png = nullptr;
  png_infop info = nullptr;
  char message[256] = "";
  std::vector<png_byte> file;
  std::vector<png_text> texts;

  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

void on_png_error(png_structp png, png_const_charp message) {
  auto* writer = static_cast<PngWriter*>(png_get_error_ptr(png));
  std::strncpy(writer->message, message, sizeof(writer->message) - 1);
  png_longjmp(png, 1);
}

void on_png_warning(png_structp, png_const_charp) {}

/// Appends; false where there is no memory (an exception must not enter libpng).
bool append(std::vector<png_byte>& file, const png_byte* bytes, size_t count) noexcept {
  try {
    file.insert(file.end(), bytes, bytes + count);
    return true;
  } catch (...) {
    return false;
  }
}

void on_write(png_structp png, png_bytep bytes, size_t count) {
  auto* writer = static_cast<PngWriter*>(png_get_io_ptr(png));
  if (!append(writer->file, bytes, count)) png_error(png, "not enough memory");
}

void on_flush(png_structp) {}

void tell_color(PngWriter& writer, ColorTag color) {
  if (color == ColorTag::srgb) png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (color == ColorTag::linear) {
    png_set_gAMA_fixed(writer.png, writer.info, PNG_FP_1);
    // Rec.709: white, red, green, blue, in 1/100000.
    png_set_cHRM_fixed(writer.png, writer.info, 31270, 32900, 64000, 33000, 30000, 60000, 15000,
                       6000);
  }
}

bool encode(PngWriter& writer, const Codes& codes, png_uint_32 width, png_uint_32 height,
            ColorTag tag) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_set_write_fn(writer.png, &writer, on_write, on_flush);
  const int color = codes.channels == 1   ? PNG_COLOR_TYPE_GRAY
                    : codes.channels == 3 ? PNG_COLOR_TYPE_RGB
                                          : PNG_COLOR_TYPE_RGB_ALPHA;
  png_set_IHDR(writer.png, writer.info, width, height, codes.bits, color, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  tell_color(writer, tag);
  if (!writer.texts.empty()) {
    png_set_text(writer.png, writer.info, writer.texts.data(),
                 static_cast<int>(writer.texts.size()));
  }
  png_write_info(writer.png, writer.info);
  const size_t row_bytes = codes.row_bytes(static_cast<int>(width));
  // A PNG has its numbers' high bytes first.
  if (codes.bits == 16 && std::endian::native == std::endian::little) png_set_swap(writer.png);
  for (png_uint_32 y = 0; y < height; ++y) {
    png_write_row(writer.png, codes.data.data() + y * row_bytes);
  }
  png_write_end(writer.png, writer.info);
  return true;
}

bool is_ascii(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<signed char>(c) > 0; });
}

/// tEXt; iTXt (UTF-8) where the value is not ASCII.
Status add_texts(PngWriter& writer, const ImageMetadata& metadata) {
  for (const auto& [name, value] : metadata) {
    const bool spaced = !name.empty() && (name.front() == ' ' || name.back() == ' ');
    if (name.empty() || name.size() > 79 || spaced || !is_ascii(name)) {
      return Error{
          fmt::format("metadata name '{}': expected 1 to 79 ASCII letters", name.substr(0, 40))};
    }
    png_text text{};
    text.compression = is_ascii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    text.key = const_cast<char*>(name.c_str());
    text.text = const_cast<char*>(value.c_str());
    writer.texts.push_back(text);
  }
  return {};
}

}  // namespace

Result<Bytes> encode_png(const Image& image, const ImageMetadata& metadata,
                         const CodeOptions& options) {
  const Result<Codes> codes = encode_codes(image, true, options.bits);
  if (!codes) return codes.error();
  const auto writer = std::make_shared<PngWriter>();
  if (const Status status = add_texts(*writer, metadata); !status) return status.error();
  writer->png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, writer.get(), on_png_error, on_png_warning);
  if (writer->png != nullptr) writer->info = png_create_info_struct(writer->png);
  if (writer->info == nullptr) return Error{"not enough memory"};
  if (!encode(*writer, *codes, static_cast<png_uint_32>(image.width),
              static_cast<png_uint_32>(image.height), options.color)) {
    return Error{writer->message};
  }
  return Bytes(writer, std::as_bytes(std::span(writer->file)));
}

Status write_png(const std::string& path, const Image& image, const ImageMetadata& metadata,
                 const CodeOptions& options) {
  const Result<Bytes> file = encode_png(image, metadata, options);
  if (!file) return file.error().in("cannot write " + path);
  return write_file(path, file->span());
}

}  // namespace hyades::core
