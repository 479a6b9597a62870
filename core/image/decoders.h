#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/read_image.h"

/// The decoders behind read_image, one per format. Each takes the whole file and trusts nothing in
/// it: sizes are checked before memory is taken, damage is an error. Errors do not name the file.
namespace hyades::core {

Result<Image> decode_png(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);
Result<Image> decode_jpeg(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);
Result<Image> decode_hdr(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);
Result<Image> decode_exr(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);

/// 8 and 16 bits or 32 of floating point, in strips or tiles, however libtiff can unpack them.
Result<Image> decode_tiff(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);

Result<Image> decode_bmp(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);
Result<Image> decode_qoi(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);
Result<Image> decode_netpbm(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);
Result<Image> decode_pfm(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);
Result<Image> decode_tga(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);

/// A lamp's photometry as a lat-long picture: see read_image.
Result<Image> decode_ies(std::span<const std::byte> file, bool srgb, const ImageLimits& limits);

/// Whether a file is a TGA picture by all that its header says: the format has no mark of its own.
bool looks_like_tga(std::span<const std::byte> file);

/// Whether the numbers of a TIFF are floating point, and so light rather than codes of a display.
bool tiff_holds_floats(std::span<const std::byte> file);

/// Refuses sizes that are empty or above the limits. Several channels count as several pixels
/// from the fifth on, so that memory stays within 16 bytes per allowed pixel.
Status check_image_size(int64_t width, int64_t height, int64_t channels, const ImageLimits& limits);

/// Makes a picture opaque whose last channel, its alpha, is 0 everywhere: TGA and BMP of many
/// programs leave the fourth byte 0 where they mean nothing by it.
void ignore_empty_alpha(Image& image);

/// Linear value of 8-bit code `code`, read as sRGB or as linear. 0..255 -> 0..1.
const float* linear_of_8_bits(bool srgb);

/// Linear values of all 65536 16-bit codes, read as sRGB or as linear.
const float* linear_of_16_bits(bool srgb);

}  // namespace hyades::core
