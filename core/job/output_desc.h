#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/job/source.h"

namespace hyades::core {

struct OutputDesc {
  SourceLocation where;
  std::string file;  ///< #### stands for the frame number
  /// As layer_names() and "light_group:NAME"; for displays: at most one, none is beauty.
  std::vector<std::string> layers;
  std::string tone_map = "srgb";  ///< srgb | filmic | aces | agx | linear; not EXR
  float exposure = 0.0F;          ///< stops
  bool half = false;              ///< EXR: 16 bits
  bool transparent = false;       ///< PNG and TIFF: alpha channel
  std::string denoise = "false";  ///< false | true | features | oidn
  int32_t jpeg_quality = 92;      ///< 1..100
  int32_t bits = 8;               ///< PNG and TIFF: 8 or 16 per channel
};

/// A video of all frames. Each frame leaves a picture for it, which is one of Job::outputs.
struct VideoDesc {
  SourceLocation where;
  std::string file;         ///< .mp4, .mov (H.264) or .webm (VP9)
  std::string pictures;     ///< OutputDesc::file of what each frame leaves: FILE.frames/####.png
  int32_t rate_factor = 0;  ///< constant: smaller is better and larger
};

}  // namespace hyades::core
