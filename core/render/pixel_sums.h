#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/film/film.h"
#include "core/integrators/integrator.h"
#include "core/integrators/light_parts.h"
#include "core/scene/film_motion.h"

namespace hyades::core {

/// A sample of a pixel as the film takes it.
struct TakenSample {
  PixelSample seen;     ///< its values times the filter's weight
  float weight = 1.0F;  ///< the filter's, at the sample's place
  float time = 0.0F;    ///< shutter time
  Ray ray;              ///< the camera's
};

/// Sums of one pixel's samples in a batch, in double precision, in the order of the samples.
class PixelSums {
 public:
  /// Both outlive the sums; the scene has FilmMotion where the layout asks for it.
  PixelSums(const FilmLayout& layout, const Scene& scene)
      : layout_(layout), scene_(scene), sums_(static_cast<size_t>(layout.deposited)) {}

  /// Before each pixel.
  void clear();

  /// Adds a sample; `parts` are those of its light, by part, without the filter's weight.
  void add(const TakenSample& sample, std::span<const Rgb> parts);

  /// Writes layout.deposited floats and returns what is behind them.
  float* write(float* out) const;

 private:
  void add_vector(int channel, const Vec3& value) {
    for (int c = 0; c < 3; ++c) sums_[static_cast<size_t>(channel + c)] += double{value[c]};
  }

  const FilmLayout& layout_;
  const Scene& scene_;
  std::vector<double> sums_;
  float depth_ = kInfinity;
};

}  // namespace hyades::core
