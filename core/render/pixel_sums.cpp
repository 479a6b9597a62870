#include "core/render/pixel_sums.h"

#include <algorithm>
#include <cstddef>

namespace hyades::core {

void PixelSums::clear() {
  std::fill(sums_.begin(), sums_.end(), 0.0);
  depth_ = kInfinity;
}

void PixelSums::add(const TakenSample& sample, std::span<const Rgb> parts) {
  const PixelSample& seen = sample.seen;
  add_vector(0, seen.radiance);
  sums_[3] += double{seen.alpha};
  depth_ = seen.depth < depth_ ? seen.depth : depth_;
  if (layout_.albedo >= 0) add_vector(layout_.albedo, seen.albedo);
  if (layout_.normal >= 0) add_vector(layout_.normal, seen.normal);
  if (layout_.position >= 0) add_vector(layout_.position, seen.position * sample.weight);
  if (layout_.motion >= 0) {
    const Vec2 motion = scene_.motion->of(scene_, seen.object, seen.primitive, seen.position,
                                          sample.ray, sample.time) *
                        sample.weight;
    sums_[static_cast<size_t>(layout_.motion)] += double{motion.x};
    sums_[static_cast<size_t>(layout_.motion) + 1] += double{motion.y};
  }
  for (size_t i = 0; i < parts.size(); ++i)
    add_vector(layout_.parts + 3 * static_cast<int>(i), parts[i] * sample.weight);
}

float* PixelSums::write(float* out) const {
  for (int c = 0; c < layout_.deposited; ++c)
    *out++ = c == layout_.depth ? depth_ : static_cast<float>(sums_[static_cast<size_t>(c)]);
  return out;
}

}  // namespace hyades::core
