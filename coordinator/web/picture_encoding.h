#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/film/film.h"
#include "core/image/image.h"
#include "core/image/tone_map.h"

namespace hyades::coordinator {

/// The layers that a normalised film (core::Film::normalised) or a finished EXR holds: "beauty",
/// where R, G and B are there, "alpha", and what stands before the dot of the other channels.
std::vector<std::string> layers_of(const core::Image& image);

/// The channels of one layer, in the image's order; the error names the layers that there are.
core::Result<core::Image> take_layer(const core::Image& image, const std::string& layer);

/// How much of each pixel is rendered, row by row: 0 nothing, 255 all of it. Empty: all of every
/// pixel.
using SampledMask = std::vector<uint8_t>;

/// Which pixels of the film have samples. Empty where all have some.
SampledMask sampled_pixels(const core::Film& film);

/// The picture averaged down to at most `width` pixels a row; pixels count by the area of theirs
/// that falls into the new one, those without samples not at all. What is not finite counts only
/// where nothing else is there. `sampled` is of `image`, and becomes what it is of the new one.
core::Image shrink(const core::Image& image, int width, SampledMask& sampled);

/// R, G, B (or Y) of a linear picture as a PNG for displays, made brighter by `exposure` stops. An
/// error where it has none of them.
core::Result<core::Bytes> display_png(const core::Image& image, core::ToneCurve curve,
                                      float exposure);

/// What half_planes() says of a picture besides its pixels.
struct HalfFacts {
  std::string layer;
  std::vector<std::string> layers;
  uint64_t samples_done = 0;
  bool exact = true;
  int full_width = 0;  ///< of the picture before it was averaged down
  int full_height = 0;
  const SampledMask* mask = nullptr;  ///< told after the planes, where it is asked for
};
/// The picture as openapi.yaml's `half`: a line of JSON, then each channel as a plane of 16-bit
/// floats (little-endian), then the mask.
std::string half_planes(const core::Image& image, const HalfFacts& facts);

}  // namespace hyades::coordinator
