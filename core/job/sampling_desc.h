#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/rect.h"

namespace hyades::core {

struct FramesDesc {
  int32_t first = 1;
  int32_t last = 1;
  int32_t step = 1;
  float fps = 24.0F;
  float shutter = 0.0F;  ///< fraction of the frame time that the shutter stays open, 0..1
};

enum class FilterKind { box, triangle, gaussian, mitchell, blackman_harris, center };

struct FilmDesc {
  int32_t width = 640;
  int32_t height = 360;
  std::optional<PixelRect> crop;  ///< pixels to render; all where absent
  FilterKind filter = FilterKind::blackman_harris;
  float filter_radius = 1.5F;  ///< pixels; half the filter's width
};

/// The part of the frame that a job renders: its crop, or everything.
inline PixelRect render_window(const FilmDesc& film) {
  const PixelRect frame{0, 0, film.width, film.height};
  return film.crop ? intersection(frame, *film.crop) : frame;
}

enum class SamplerName { sobol, independent };

struct SamplingDesc {
  uint32_t samples = 64;  ///< per pixel
  uint64_t seed = 0;
  SamplerName sampler = SamplerName::sobol;
};

struct IntegratorDesc {
  std::string type = "path";
  int max_depth = 32;      ///< most scattering events between light and camera
  int roulette_depth = 4;  ///< Russian roulette may end a path after this many
  float clamp = 0.0F;      ///< path; biased: largest radiance of one indirect sample; 0 = off

  // bdpt: to look at one strategy alone.
  int light_vertices = -1;   ///< s: only paths of which the light path gives so many; -1: all
  int camera_vertices = -1;  ///< t, likewise
  bool mis = true;           ///< false: unweighted

  // mlt.
  std::string over = "bdpt";  ///< path | bdpt: whose samples the chains mutate
  float large_step = 0.3F;    ///< probability of an independent sample, (0, 1]

  // Not keys of jobs: fewer, or more, scattering events bring no light.
  int min_events = 0;
  int max_events = 1 << 30;
};

}  // namespace hyades::core
