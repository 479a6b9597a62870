#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::core {

/// Key-value texts stored in the file's header (EXR attributes, PNG tEXt).
using ImageMetadata = std::vector<std::pair<std::string, std::string>>;

/// Writes all channels as 32-bit float (or 16-bit half where `half`: finite values stay finite),
/// ZIP-compressed. The file is complete or absent: written to a temporary name, synced, renamed.
Status write_exr(const std::string& path, const Image& image, const ImageMetadata& metadata = {},
                 bool half = false);

/// Writes an 8-bit PNG of channels R, G, B and, where there, A (straight), or else of Y; other
/// channels are left out. Values are already display-encoded, 0..1, clamped and rounded to nearest
/// (NaN to 0). Complete or absent as write_exr.
Status write_png(const std::string& path, const Image& image, const ImageMetadata& metadata = {});

/// As write_png, JPEG of quality 1..100, without alpha; full colour resolution from quality 90 on.
Status write_jpeg(const std::string& path, const Image& image, int quality = 92);

}  // namespace hyades::core
