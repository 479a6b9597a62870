#pragma once

#include <cstdint>
#include <string>

#include "core/base/rect.h"

namespace hyades::core {

/// What a job says of the noise at which tiles have samples enough (docs/job.md, sampling.noise).
struct NoiseAim {
  float noise = 0;           ///< see tile_noise(); 0: every tile gets all samples
  float exposure = 0;        ///< stops, with which the picture is looked at
  uint32_t min_samples = 0;  ///< that every pixel gets before its tile is judged
  friend bool operator==(const NoiseAim&, const NoiseAim&) = default;
};

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
  NoiseAim aim;              ///< when a tile has samples enough
};

}  // namespace hyades::core
