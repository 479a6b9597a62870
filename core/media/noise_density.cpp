#include "core/media/noise_density.h"

#include <algorithm>
#include <cmath>

#include "core/textures/noise.h"
#include "core/textures/noise_bounds.h"

namespace hyades::core {
namespace {

class NoiseField final : public DensityField {
 public:
  NoiseField(const NoiseDensity& noise, const Bounds& bounds)
      : noise_(noise),
        fractal_(noise.octaves, noise.lacunarity, noise.gain),
        bounds_(bounds),
        center_(bounds.center()) {
    const Vec3 half = 0.5F * bounds.size();
    for (int a = 0; a < 3; ++a) per_half_[a] = half[a] > 0.0F ? 1.0F / half[a] : 0.0F;
  }

  float at(const Vec3& p) const override {
    if (p != glm::clamp(p, bounds_.lower, bounds_.upper)) return 0.0F;
    const float thinning = thinning_at(length((p - center_) * per_half_));
    if (thinning <= -1.0F) return 0.0F;
    const float n = fractal_.value_between(Vec4(p * noise_.scale + noise_.offset, noise_.time),
                                           noise_of(noise_.low, thinning),
                                           noise_of(std::max(noise_.low, noise_.high), thinning));
    return density_of(0.5F + 0.5F * n + thinning);
  }

  Extent over(const Bounds& box) const override {
    // The box's nearest and farthest point from the middle.
    const Vec3 a = (box.lower - center_) * per_half_;
    const Vec3 b = (box.upper - center_) * per_half_;
    const Vec3 far = glm::max(glm::abs(a), glm::abs(b));
    const Vec3 near = glm::max(glm::max(a, -b), Vec3(0.0F));
    const float most = thinning_at(length(near));
    if (most <= -1.0F) return {0.0F, 0.0F};
    const Vec3 c = box.lower * noise_.scale + noise_.offset;
    const Vec3 d = box.upper * noise_.scale + noise_.offset;
    const NoiseBounds n =
        fbm_bounds(Vec4(glm::min(c, d), noise_.time), Vec4(glm::max(c, d), noise_.time),
                   noise_.octaves, noise_.lacunarity, noise_.gain);
    const bool all_inside = box.lower == glm::clamp(box.lower, bounds_.lower, bounds_.upper) &&
                            box.upper == glm::clamp(box.upper, bounds_.lower, bounds_.upper);
    const float least = density_of(0.5F + 0.5F * n.least + thinning_at(length(far)));
    return {all_inside ? least : 0.0F, density_of(0.5F + 0.5F * n.greatest + most)};
  }

  Bounds bounds() const override { return bounds_; }

 private:
  static float length(const Vec3& v) { return std::sqrt(glm::dot(v, v)); }

  /// At `distance` from the middle, 1 at the ellipsoid.
  float thinning_at(float distance) const {
    if (noise_.fade <= 0.0F) return 0.0F;
    return std::clamp((1.0F - distance) / noise_.fade, 0.0F, 1.0F) - 1.0F;
  }

  /// The noise that makes `value`, what density_of goes by.
  static float noise_of(float value, float thinning) { return 2.0F * (value - 0.5F - thinning); }

  float density_of(float value) const {
    if (noise_.high <= noise_.low) return value > noise_.low ? 1.0F : 0.0F;
    return std::clamp((value - noise_.low) / (noise_.high - noise_.low), 0.0F, 1.0F);
  }

  NoiseDensity noise_;
  FractalNoise fractal_;
  Bounds bounds_;
  Vec3 center_;
  Vec3 per_half_;
};

}  // namespace

std::shared_ptr<const DensityField> make_noise_density(const NoiseDensity& noise,
                                                       const Bounds& bounds) {
  return std::make_shared<NoiseField>(noise, bounds);
}

}  // namespace hyades::core
