#pragma once

#include <cstdint>
#include <string>

#include "core/base/rect.h"

namespace hyades::core {

/// What a film belongs to. Films with different render keys, frames, sizes or classes never merge.
struct FilmInfo {
  std::string job_name;
  std::string render_key;  ///< hex SHA-256 of what decides the frame's pixels
  int32_t frame = 0;
  int32_t width = 0;  ///< full frame, pixels
  int32_t height = 0;
  PixelRect crop;            ///< the part of the frame that the job renders
  uint32_t samples = 0;      ///< per pixel, of the whole job, at most
  std::string worker_class;  ///< hash of the probe film of the machines that rendered it
  std::string build;         ///< renderer version and build id
  float noise = 0;           ///< at which a tile has samples enough; 0: it gets all
};

}  // namespace hyades::core
