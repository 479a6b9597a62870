#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/image/encode_codes.h"
#include "core/image/write_image.h"

namespace hyades::core {
namespace {

constexpr size_t kStripBytes = 65536;

/// Keeps the first complaint; libtiff would print it.
int on_tiff_error(TIFF*, void* user_data, const char*, const char* format, va_list arguments) {
  auto& message = *static_cast<std::string*>(user_data);
  char text[256] = "";
  std::vsnprintf(text, sizeof(text), format, arguments);
  if (message.empty()) message = text;
  return 1;
}

int on_tiff_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

using Handle = std::unique_ptr<TIFF, void (*)(TIFF*)>;

Handle open_tiff(const std::string& path, std::string& message) {
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_tiff_error, &message);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_tiff_warning, nullptr);
  return {TIFFOpenExt(path.c_str(), "w", options.get()), TIFFClose};
}

void describe(TIFF* tiff, const Image& image, const Codes& codes, const ImageMetadata& metadata,
              const CodeOptions& options) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<uint32_t>(image.width));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<uint32_t>(image.height));
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, static_cast<unsigned>(codes.bits));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, static_cast<unsigned>(codes.channels));
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC,
               codes.channels == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
  if (codes.channels == 4) {
    const uint16_t straight[] = {EXTRASAMPLE_UNASSALPHA};
    TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1U, straight);
  }
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP,
               static_cast<uint32_t>(std::max<size_t>(
                   1, kStripBytes / std::max<size_t>(1, codes.row_bytes(image.width)))));
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, fmt::format("hyades {}", kVersion).c_str());
  const std::string lines = metadata_lines(metadata);
  if (!lines.empty()) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, lines.c_str());
  const std::vector<uint8_t> profile = icc_profile(options.color);
  if (!profile.empty()) {
    TIFFSetField(tiff, TIFFTAG_ICCPROFILE, static_cast<uint32_t>(profile.size()), profile.data());
  }
}

Status write(const std::string& path, const Image& image, Codes& codes,
             const ImageMetadata& metadata, const CodeOptions& options) {
  std::string message;
  bool written = false;
  {
    const Handle tiff = open_tiff(path, message);
    if (tiff) {
      describe(tiff.get(), image, codes, metadata, options);
      written = true;
      const size_t row_bytes = codes.row_bytes(image.width);
      for (int y = 0; y < image.height && written; ++y) {
        written =
            TIFFWriteScanline(tiff.get(), codes.data.data() + static_cast<size_t>(y) * row_bytes,
                              static_cast<uint32_t>(y)) == 1;
      }
      if (written) written = TIFFFlush(tiff.get()) == 1;
    }
  }
  // Closing may complain too.
  if (written && message.empty()) return {};
  return Error{message.empty() ? "it could not be written" : message};
}

}  // namespace

Status write_tiff(const std::string& path, const Image& image, const ImageMetadata& metadata,
                  const CodeOptions& options) {
  const std::string context = "cannot write " + path;
  auto codes = encode_codes(image, true, options.bits);
  if (!codes) return codes.error().in(context);
  return replace_file(path, [&](const std::string& temporary) -> Status {
    const Status written = write(temporary, image, *codes, metadata, options);
    return written ? written : written.error().in(context);
  });
}

}  // namespace hyades::core
