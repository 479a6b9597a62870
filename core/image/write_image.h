#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/image/icc_profile.h"
#include "core/image/image.h"

namespace hyades::core {

/// Key-value texts stored in the file's header (EXR attributes, PNG tEXt, JPEG comment, TIFF
/// ImageDescription).
using ImageMetadata = std::vector<std::pair<std::string, std::string>>;

/// "name: value" of each, one a line: for formats that keep one text.
std::string metadata_lines(const ImageMetadata& metadata);

/// How the codes of a picture for displays are made and named.
struct CodeOptions {
  int bits = 8;  ///< 8 or 16 per channel; JPEG has 8
  ColorTag color = ColorTag::srgb;
};

/// Writes all channels as 32-bit float (or 16-bit half where `half`: finite values stay finite, and
/// bits that are names stay as they are: "CryptoObject00.R", ..., "object_id.ID"), ZIP-compressed.
/// The file is complete or absent: written to a temporary name, synced, renamed.
Status write_exr(const std::string& path, const Image& image, const ImageMetadata& metadata = {},
                 bool half = false);

/// The file of write_exr() in memory.
Result<Bytes> encode_exr(const Image& image, const ImageMetadata& metadata = {}, bool half = false);

/// Writes a PNG of channels R, G, B and, where there, A (straight), or else of Y; other channels
/// are left out. Values are already display-encoded, 0..1, clamped and rounded to nearest (NaN to
/// 0). Its colour space is told by the chunk sRGB, or by gAMA (1) and cHRM where it is linear.
/// Complete or absent as write_exr.
Status write_png(const std::string& path, const Image& image, const ImageMetadata& metadata = {},
                 const CodeOptions& options = {});

/// The file of write_png() in memory.
Result<Bytes> encode_png(const Image& image, const ImageMetadata& metadata = {},
                         const CodeOptions& options = {});

/// Writes a TIFF of the channels and values that write_png() takes: deflate with differences, in
/// strips; an ICC profile tells the colour space.
Status write_tiff(const std::string& path, const Image& image, const ImageMetadata& metadata = {},
                  const CodeOptions& options = {});

/// Writes a JPEG of quality 1..100 of the channels and values that write_png() takes, without
/// alpha; full colour resolution from quality 90 on. An ICC profile tells the colour space.
Status write_jpeg(const std::string& path, const Image& image, int quality = 92,
                  const ImageMetadata& metadata = {}, ColorTag color = ColorTag::srgb);

}  // namespace hyades::core
