#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/base/elementary.h"
#include "core/textures/noise_octaves.h"
#include "core/textures/pattern.h"

namespace hyades::core {
namespace {

/// One octave at `p`.
Noise3 octave_at(const Vec3& p, const Octave& octave, const std::optional<float>& time) {
  const Vec3 place = p * octave.frequency + Vec3(octave.shift);
  if (!time) return perlin(place);
  const Noise4 n = perlin(Vec4(place, *time * octave.frequency + octave.shift.w));
  return {n.value, Vec3(n.gradient)};
}

/// The weighted mean of shape(noise) over the octaves; `shape` makes Noise3 of Noise3.
template <class Shape>
Noise3 mean_of_octaves(const FractalDesc& desc, const Vec3& p, const Shape& shape) {
  Noise3 total;
  const float norm =
      for_each_octave(desc.octaves, desc.lacunarity, desc.gain, [&](const Octave& octave) {
        const Noise3 n = shape(octave_at(p, octave, desc.time));
        total.value += octave.amplitude * n.value;
        total.gradient += octave.amplitude * octave.frequency * n.gradient;
      });
  return {total.value / norm, total.gradient / norm};
}

Noise3 fbm_of(const FractalDesc& desc, const Vec3& p) {
  return mean_of_octaves(desc, p, [](const Noise3& n) { return n; });
}

Noise3 absolute(const Noise3& n) { return n.value < 0.0F ? Noise3{-n.value, -n.gradient} : n; }

Noise3 ridge(const Noise3& n) {
  const Noise3 a = absolute(n);
  const float height = 1.0F - a.value;
  return {height * height, -2.0F * height * a.gradient};
}

/// Within [0, 1] whatever rounding did.
Noise3 held(const Noise3& n) {
  if (n.value <= 0.0F) return {0.0F, Vec3(0.0F)};
  if (n.value >= 1.0F) return {1.0F, Vec3(0.0F)};
  return n;
}

class Fractal final : public Pattern {
 public:
  Fractal(FractalKind kind, const FractalDesc& desc) : kind_(kind), desc_(desc) {}

  Noise3 at(const Vec3& p) const override {
    switch (kind_) {
      case FractalKind::turbulence:
        return held(mean_of_octaves(desc_, p, absolute));
      case FractalKind::ridged:
        return held(mean_of_octaves(desc_, p, ridge));
      case FractalKind::fbm:
        break;
    }
    const Noise3 n = fbm_of(desc_, p);
    return held({0.5F + 0.5F * n.value, 0.5F * n.gradient});
  }

 private:
  FractalKind kind_;
  FractalDesc desc_;
};

class Marble final : public Pattern {
 public:
  Marble(const FractalDesc& desc, float distortion) : desc_(desc), distortion_(distortion) {}

  Noise3 at(const Vec3& p) const override {
    const Noise3 n = fbm_of(desc_, p);
    const auto [s, c] = sin_cos(2.0F * kPi * (p.x + distortion_ * n.value));
    const Vec3 bent = Vec3(1.0F, 0.0F, 0.0F) + distortion_ * n.gradient;
    return {0.5F + 0.5F * s, (kPi * c) * bent};
  }

 private:
  FractalDesc desc_;
  float distortion_;
};

class Wood final : public Pattern {
 public:
  Wood(const FractalDesc& desc, float distortion) : desc_(desc), distortion_(distortion) {}

  Noise3 at(const Vec3& p) const override {
    const Noise3 n = fbm_of(desc_, p);
    const float radius = std::sqrt(p.x * p.x + p.z * p.z);
    const Vec3 outwards = radius > 0.0F ? Vec3(p.x / radius, 0.0F, p.z / radius) : Vec3(0.0F);
    const float ring = radius + distortion_ * n.value;
    const Vec3 gradient = outwards + distortion_ * n.gradient;
    const float t = ring - std::floor(ring);
    constexpr float kRise = 0.9F;
    const bool rises = t < kRise;
    const float u = rises ? t / kRise : (1.0F - t) / (1.0F - kRise);
    const float slope = 6.0F * u * (1.0F - u) * (rises ? 1.0F / kRise : -1.0F / (1.0F - kRise));
    return {u * u * (3.0F - 2.0F * u), slope * gradient};
  }

 private:
  FractalDesc desc_;
  float distortion_;
};

}  // namespace

PatternPtr make_fractal_pattern(FractalKind kind, const FractalDesc& desc) {
  return std::make_shared<Fractal>(kind, desc);
}
PatternPtr make_marble_pattern(const FractalDesc& desc, float distortion) {
  return std::make_shared<Marble>(desc, distortion);
}
PatternPtr make_wood_pattern(const FractalDesc& desc, float distortion) {
  return std::make_shared<Wood>(desc, distortion);
}

}  // namespace hyades::core
