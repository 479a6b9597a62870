#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/rect.h"

namespace hyades::core {

/// How a channel of two films becomes one.
enum class MergeRule : uint8_t {
  sum,  ///< exact addition (Q64.64)
  min,  ///< the smaller (depth)
};

/// What a film can hold besides beauty.
struct LayerSet {
  bool depth = false;   ///< distance to the camera plane (camera-space z) of the nearest first hit
  bool albedo = false;  ///< reflectance at the first non-specular hit
  bool normal = false;  ///< world-space shading normal at the first hit
  bool splats = false;  ///< not a layer of the picture: beauty has a part that light paths brought
  friend bool operator==(const LayerSet&, const LayerSet&) = default;
};

struct FilmChannel {
  std::string name;  ///< EXR name: "R", "A", "depth.Z", "albedo.R", "normal.X", "moment2.R", ...
  MergeRule rule = MergeRule::sum;
  friend bool operator==(const FilmChannel&, const FilmChannel&) = default;
};

/// The channels of a film in fixed order. Deposited channels come first (the integrator fills them
/// in this order: R G B A [depth.Z] [albedo.R G B] [normal.X Y Z]); behind them those that the film
/// derives itself: moment2.R G B (sum over batches of s^2 / n, where s is the batch's sum over its
/// n samples) and samples.N (how many samples the pixel holds).
struct FilmLayout {
  LayerSet layers;
  std::vector<FilmChannel> channels;
  int deposited = 0;  ///< how many channels the renderer deposits
  int depth = -1;     ///< index of depth.Z, or -1
  int albedo = -1;    ///< index of albedo.R, or -1
  int normal = -1;    ///< index of normal.X, or -1
  int moment2 = -1;   ///< index of moment2.R
  int samples = -1;   ///< index of samples.N
  friend bool operator==(const FilmLayout&, const FilmLayout&) = default;
};

FilmLayout make_film_layout(const LayerSet& layers);

/// Bytes that the sums of a film take in memory at most, splats being those of its window's pixels.
uint64_t film_memory(const FilmLayout& layout, const PixelRect& window);
/// The same where the splats are those of all of `region`, which contains the window.
uint64_t film_memory(const FilmLayout& layout, const PixelRect& window, const PixelRect& region);

}  // namespace hyades::core
