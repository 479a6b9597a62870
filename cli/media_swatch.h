#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/media_facts.h"
#include "core/base/result.h"

namespace hyades::cli {

struct SwatchOptions {
  std::string file;       ///< .png, .jpg or .exr
  float size = 0.02F;     ///< m, diameter of a ball
  uint32_t samples = 40;  ///< per pixel
  int threads = 1;
  bool quiet = false;
};

/// Renders a row of balls of the media, each of its index of refraction, on a striped table that
/// shows through what is clear.
core::Status render_swatch(const std::vector<KnownMedium>& media, const SwatchOptions& options);

}  // namespace hyades::cli
