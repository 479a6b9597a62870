#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/base/elementary.h"
#include "core/media/attenuation.h"
#include "core/media/make_medium.h"
#include "core/media/shares.h"

namespace hyades::core {
namespace {

/// Distances are chosen for one channel, which itself is chosen by what the path carries; the
/// weight divides by the mean density over all channels (balance heuristic; Wilkie et al. 2014,
/// "Hero Wavelength Spectral Sampling", applied to channels).
class Homogeneous final : public Medium {
 public:
  Homogeneous(const Rgb& absorption, const Rgb& scattering, const Rgb& emission, const Phase& phase)
      : scattering_(scattering),
        extinction_(absorption + scattering),
        emission_(emission),
        phase_(phase),
        scatters_(!is_black(scattering)),
        emits_(!is_black(emission)) {}

  MediumSample sample(const Ray&, float t_max, const Rgb& shares, const Vec4& u) const override {
    MediumSample result;
    if (!scatters_) {
      result.weight = attenuation(extinction_, t_max);
      return result;
    }
    const float chosen = extinction_[choose_channel(shares, u.x).index];
    const float t = chosen > 0.0F ? -log1p(-u.y) / chosen : kInfinity;
    result.scattered = t < t_max;
    result.t = std::min(t, t_max);
    const Rgb passed = relative_attenuation(extinction_, result.t, shares);
    if (result.scattered) {
      const float density = glm::dot(shares, extinction_ * passed);
      result.weight = density > 0.0F ? passed * scattering_ / density : Rgb(0.0F);
    } else {
      result.weight = passed / glm::dot(shares, passed);
    }
    return result;
  }

  std::optional<FlightDensity> flight_density(float t, const Rgb& shares) const override {
    if (!scatters_) return std::nullopt;
    const Rgb passed = attenuation(extinction_, t);
    return FlightDensity{passed * scattering_, glm::dot(shares, extinction_ * passed)};
  }

  Rgb transmittance(const Ray&, float t_max, const Vec4&) const override {
    return attenuation(extinction_, t_max);
  }

  /// In closed form: the integral of emission exp(-extinction t).
  Rgb emitted(const Ray&, float t_max, const Vec4&) const override {
    if (!emits_) return Rgb(0.0F);
    Rgb sum;
    for (int c = 0; c < 3; ++c) {
      const float sigma = extinction_[c];
      const float depth = sigma > 0.0F ? sigma * t_max : 0.0F;
      const float length = depth > 0.0F ? -expm1(-depth) / sigma : t_max;
      sum[c] = emission_[c] > 0.0F ? emission_[c] * length : 0.0F;
    }
    return sum;
  }

  const Phase& phase() const override { return phase_; }

  Rgb albedo(const Vec3&) const override {
    Rgb share;
    for (int c = 0; c < 3; ++c) {
      share[c] = extinction_[c] > 0.0F ? scattering_[c] / extinction_[c] : 0.0F;
    }
    return share;
  }

 private:
  Rgb scattering_;
  Rgb extinction_;
  Rgb emission_;
  Phase phase_;
  bool scatters_;
  bool emits_;
};

}  // namespace

MediumPtr make_homogeneous(const Rgb& absorption, const Rgb& scattering, const Rgb& emission,
                           const Phase& phase) {
  return std::make_shared<Homogeneous>(absorption, scattering, emission, phase);
}

}  // namespace hyades::core
