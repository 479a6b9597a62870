#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::core {

/// How the numbers of an 8- or 16-bit file become linear.
enum class ColorSpace {
  automatic,  ///< codes of 8 and 16 bits as sRGB; EXR, HDR, PFM and floats of TIFF as linear
  srgb,
  linear,
};

/// Limits against hostile files, checked before memory is taken.
struct ImageLimits {
  int max_side = 65536;             ///< pixels
  size_t max_pixels = 400'000'000;  ///< width * height
};

/// Decodes PNG (1-16 bits), JPEG, TIFF (grey or RGB of 8, 16 or 32 floating bits; the first
/// picture), TGA, BMP (not packed), QOI, binary PPM and PGM, PFM, Radiance HDR (flat and RLE) or
/// OpenEXR (any compression, half or float, scanline or tiled), told apart by their first bytes,
/// TGA by its whole header. IES profiles of lamps (LM-63 with its first line, photometry of type C)
/// become lat-long pictures (EnvironmentMap) of 720 x 360 pixels, straight down being -y and
/// horizontal angles going from x towards -z: of 4 pi / 177.83 times the candela, so that a point
/// light of 1 W with it is the lamp, at the 177.83 lm/W of illuminant D65 that Cycles counts with.
/// Colour is linear Rec.709 on return; alpha stays straight and is never decoded. Grey files have
/// channel "Y"[,"A"], colour ones "R","G","B"[,"A"]; an EXR keeps its own channel names, R G B A Y
/// first (first part, all of its data window; subsampled channels and deep data are refused).
/// EXPOSURE of a Radiance file is undone, so that pixels are radiances. Files that are truncated,
/// damaged, CMYK or beyond `limits` are errors. `name` is used in errors only. Thread-safe.
Result<Image> read_image(const Bytes& bytes, const std::string& name,
                         ColorSpace space = ColorSpace::automatic, const ImageLimits& limits = {});

/// read_image of a file on disk.
Result<Image> read_image_file(const std::string& path, ColorSpace space = ColorSpace::automatic);

/// The texts in the header of the PNG file at `path` (tEXt, and iTXt that is not compressed), in
/// their order.
Result<std::vector<std::pair<std::string, std::string>>> read_png_texts(const std::string& path);

/// The texts in the (first) header of the OpenEXR file at `path`, by name.
Result<std::vector<std::pair<std::string, std::string>>> read_exr_texts(const std::string& path);

}  // namespace hyades::core
