#include "core/media/phase.h"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.h"
#include "core/base/frame.h"
#include "core/media/shares.h"

namespace hyades::core {
namespace {

constexpr float kInvFourPi = 0.25F * kInvPi;

float henyey_greenstein_value(float cosine, float g) {
  // (1 - g)^2 + 2 g (1 - cos) loses nothing where g is near 1 and the angle small.
  const float d = (1.0F - g) * (1.0F - g) + 2.0F * g * (1.0F - cosine);
  return kInvFourPi * (1.0F - g * g) / (d * std::sqrt(d));
}

/// A cosine and the sine that belongs to it.
struct Deflection {
  float cosine;
  float sine;
};

/// Inverts the cumulative distribution. Written out, the formula of the books divides by g and
/// subtracts what is nearly equal; 1 - cos and 1 + cos factor instead into products that are exact
/// for every g in (-1, 1), 0 included.
Deflection sample_henyey_greenstein(float g, float u) {
  const float d = 1.0F - g + 2.0F * g * u;
  const float below = 2.0F * (1.0F - g) * (1.0F - g) * (1.0F - u) * (1.0F + g * u) / (d * d);
  const float above = 2.0F * (1.0F + g) * (1.0F + g) * u * (1.0F - g * (1.0F - u)) / (d * d);
  const float cosine = below < above ? 1.0F - below : above - 1.0F;
  return {cosine, std::sqrt(std::max(below * above, 0.0F))};
}

/// The root of cos^3 + 3 cos + 4 = 8 u.
Deflection sample_rayleigh(float u) {
  const float half = 4.0F * u - 2.0F;
  const float a = cbrt(std::abs(half) + std::sqrt(half * half + 1.0F));
  const float root = std::min(a - 1.0F / a, 1.0F);
  const float cosine = half < 0.0F ? -root : root;
  return {cosine, std::sqrt(std::max(1.0F - cosine * cosine, 0.0F))};
}

float rayleigh_value(float cosine) { return 0.75F * kInvFourPi * (1.0F + cosine * cosine); }

}  // namespace

Phase Phase::henyey_greenstein(const Rgb& g) {
  Phase phase;
  phase.g_ = g;
  return phase;
}

Phase Phase::two_lobes(const Rgb& g, const Rgb& other_g, float blend) {
  Phase phase;
  phase.g_ = g;
  phase.other_g_ = other_g;
  phase.blend_ = blend;
  return phase;
}

Phase Phase::rayleigh() {
  Phase phase;
  phase.rayleigh_ = true;
  return phase;
}

Rgb Phase::evaluate(float cosine) const {
  if (rayleigh_) return Rgb(rayleigh_value(cosine));
  Rgb value;
  for (int c = 0; c < 3; ++c) {
    value[c] = henyey_greenstein_value(cosine, g_[c]);
    if (blend_ > 0.0F) {
      value[c] = (1.0F - blend_) * value[c] + blend_ * henyey_greenstein_value(cosine, other_g_[c]);
    }
  }
  return value;
}

float Phase::pdf(float cosine, const Rgb& shares) const {
  return glm::dot(shares, evaluate(cosine));
}

Vec3 Phase::sample(const Vec3& travel, const Rgb& shares, float pick, const Vec2& u) const {
  Deflection turn{};
  if (rayleigh_) {
    turn = sample_rayleigh(u.x);
  } else {
    const ChosenChannel channel = choose_channel(shares, pick);
    const Rgb& g = channel.rest < blend_ ? other_g_ : g_;
    turn = sample_henyey_greenstein(g[channel.index], u.x);
  }
  const SinCos around = sin_cos(2.0F * kPi * u.y);
  const Frame frame = Frame::around(travel);
  return glm::normalize(
      frame.to_world({turn.sine * around.cos, turn.sine * around.sin, turn.cosine}));
}

}  // namespace hyades::core
