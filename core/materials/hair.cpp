#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/elementary.h"
#include "core/materials/fresnel.h"
#include "core/materials/local.h"
#include "core/materials/make_hair.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

/// Lobes: mirrored at the outside, through, mirrored once inside, and all others as one.
constexpr size_t kLobes = 4;
constexpr size_t kRest = kLobes - 1;

/// Modified Bessel function of the first kind of order 0, for |x| <= 12.
float bessel_i0(float x) {
  float sum = 1.0F;
  float term = 1.0F;
  const float quarter = 0.25F * x * x;
  for (int i = 1; i < 22; ++i) {
    term *= quarter / static_cast<float>(i * i);
    sum += term;
  }
  return sum;
}

float log_bessel_i0(float x) {
  if (x > 12.0F) {  // Abramowitz and Stegun 1964, 9.7.1
    const float e = 1.0F / (8.0F * x);
    const float series = e * (1.0F + e * (4.5F + e * (37.5F + e * 459.375F)));
    return x - 0.5F * log(2.0F * kPi * x) + log1p(series);
  }
  return log(bessel_i0(x));
}

/// An angle to the strand's cross-section.
struct Inclination {
  float sine;
  float cosine;
};

/// Density over the sine of the angle to the cross-section, of a lobe of variance v about `o`
/// (d'Eon et al. 2011, equation 7; for small v in logarithms, d'Eon 2013).
float along_density(const Inclination& i, const Inclination& o, float v) {
  const float a = i.cosine * o.cosine / v;
  const float b = i.sine * o.sine / v;
  if (v <= 0.1F) return exp(log_bessel_i0(a) - b - 1.0F / v + 0.69314718F + log(1.0F / (2.0F * v)));
  const float e = exp(1.0F / v);
  return exp(-b) * bessel_i0(a) / ((e - 1.0F / e) * v);
}

float logistic(float x, float s) {
  const float e = exp(-std::abs(x) / s);
  return e / (s * (1.0F + e) * (1.0F + e));
}

float logistic_below(float x, float s) { return 1.0F / (1.0F + exp(-x / s)); }

/// Of the logistic distribution, what lies within half a turn to both sides.
float logistic_share(float s) { return logistic_below(kPi, s) - logistic_below(-kPi, s); }

float sample_logistic(float u, float s) {
  const float x = -s * log(1.0F / (u * logistic_share(s) + logistic_below(-kPi, s)) - 1.0F);
  return std::clamp(x, -kPi, kPi);
}

/// An angle in [-pi, pi].
float wrapped(float angle) {
  const float turns = std::floor(angle * (0.5F * kInvPi) + 0.5F);
  return std::clamp(angle - turns * (2.0F * kPi), -kPi, kPi);
}

float powered(float x, int n) {
  float result = 1.0F;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

/// What of a strand does not depend on the place.
struct Scales {
  std::array<Inclination, 3> turn;  ///< by which lobes are turned along the strand
};

class HairBsdf final : public Bsdf {
 public:
  HairBsdf(const Rgb& absorption, float roughness, float radial_roughness, float ior,
           const Scales& scales)
      : absorption_(absorption), ior_(ior), scales_(scales) {
    // Fits of the paper: equations 7 and 8.
    const float m = std::max(roughness, 0.01F);
    const float n = std::max(radial_roughness, 0.01F);
    const float width = 0.726F * m + 0.812F * m * m + 3.7F * powered(m, 20);
    const float v = width * width;
    variance_ = {v, 0.25F * v, 4.0F * v, 4.0F * v};
    constexpr float kRootOfEighthPi = 0.626657069F;
    scale_ = kRootOfEighthPi * (0.265F * n + 1.194F * n * n + 5.372F * powered(n, 22));
    share_ = logistic_share(scale_);
  }

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    if (mode == TransportMode::radiance) return scattered(wo, wi);
    // The model is not the same both ways: where the strand is looked from says where it is met.
    const float out = std::abs(wo.z);
    return out > 0.0F ? scattered(wi, wo) * (std::abs(wi.z) / out) : Rgb(0.0F);
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    const Meeting met(*this, wo);
    const Inclination i = inclination(wi);
    const float phi = atan2(wi.z, wi.y) - met.phi;
    float sum = 0.0F;
    for (size_t p = 0; p < kLobes; ++p) sum += met.chance[p] * density(met, i, phi, p);
    return sum;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override {
    const Meeting met(*this, wo);
    size_t p = 0;
    float below = 0.0F;
    while (p < kRest && lobe >= below + met.chance[p]) below += met.chance[p++];
    if (!(met.chance[p] > 0.0F)) return std::nullopt;
    const float rest = rest_of(lobe, below, met.chance[p]);
    // Along the strand: d'Eon 2013, "A Fiber Scattering Model with Non-Separable Lobes".
    const Inclination o = turned(met.wo, p);
    const float v = variance_[p];
    const float x = std::max(u.x, 1e-5F);
    const float cosine = 1.0F + v * log(x + (1.0F - x) * exp(-2.0F / v));
    const float sine = std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
    const float along = -cosine * o.sine + sine * cos(2.0F * kPi * rest) * o.cosine;
    const Inclination i{along, std::sqrt(std::max(0.0F, 1.0F - along * along))};
    const float around =
        p == kRest ? 2.0F * kPi * u.y : met.direction(p) + sample_logistic(u.y, scale_);
    const SinCos phi = sin_cos(wrapped(met.phi + around));
    BsdfSample s;
    s.wi = {i.sine, i.cosine * phi.cos, i.cosine * phi.sin};
    s.pdf = pdf(wo, s.wi, mode);
    if (!(s.pdf > 0.0F)) return std::nullopt;
    s.weight = evaluate(wo, s.wi, mode) / s.pdf;
    s.transmitted = wo.z * s.wi.z < 0.0F;
    return s;
  }

  Rgb albedo(const Vec3& wo) const override {
    const Meeting met(*this, wo);
    return met.light[0] + met.light[1] + met.light[2] + met.light[3];
  }

  Spread spread(float side) const override {
    const Rgb all = albedo({0.0F, 0.0F, side});
    return {.wide = 0.5F * all, .wide_through = 0.5F * all};
  }

 private:
  static Inclination inclination(const Vec3& w) {
    return {w.x, std::sqrt(std::max(0.0F, 1.0F - w.x * w.x))};
  }

  /// A ray from wo meets the strand.
  struct Meeting {
    Meeting(const HairBsdf& hair, const Vec3& direction)
        : wo(inclination(direction)), phi(atan2(direction.z, direction.y)) {
      // How far beside the axis, in radii: the sine of the angle between the ray and the normal,
      // in the cross-section.
      const float across = std::sqrt(direction.y * direction.y + direction.z * direction.z);
      float h = across > 0.0F ? -direction.y / across : 0.0F;
      if (direction.z < 0.0F) h = -h;
      gamma = asin(h);
      // Refracted along the strand, and in its cross-section with the index that Marschner et al.
      // 2003 give for that.
      const float sine_along = wo.sine / hair.ior_;
      const float cosine_along = std::sqrt(std::max(0.0F, 1.0F - sine_along * sine_along));
      const float index = std::sqrt(std::max(0.0F, hair.ior_ * hair.ior_ - wo.sine * wo.sine)) /
                          std::max(wo.cosine, 1e-6F);
      const float sine = h / index;
      gamma_inside = asin(sine);
      const float cosine = std::sqrt(std::max(0.0F, 1.0F - sine * sine));
      const float way = 2.0F * cosine / std::max(cosine_along, 1e-6F);
      Rgb through;
      for (int c = 0; c < 3; ++c) through[c] = exp(-hair.absorption_[c] * way);
      const float mirrored =
          fresnel_dielectric(wo.cosine * std::sqrt(std::max(0.0F, 1.0F - h * h)), hair.ior_)
              .reflectance;
      const float enters = 1.0F - mirrored;
      light[0] = Rgb(mirrored);
      light[1] = enters * enters * through;
      light[2] = light[1] * through * mirrored;
      light[3] =
          light[2] * mirrored * through / glm::max(Rgb(1.0F) - through * mirrored, Rgb(1e-6F));
      float sum = 0.0F;
      for (size_t p = 0; p < kLobes; ++p) sum += chance[p] = luminance(light[p]);
      for (float& c : chance) c = sum > 0.0F ? c / sum : 0.0F;
    }

    /// The angle around the strand from where the ray came to where lobe p goes.
    float direction(size_t p) const {
      const float passes = static_cast<float>(p);
      return 2.0F * passes * gamma_inside - 2.0F * gamma + passes * kPi;
    }

    Inclination wo;
    float phi;
    float gamma = 0.0F;
    float gamma_inside = 0.0F;
    std::array<Rgb, kLobes> light{};     ///< the share of it in each lobe
    std::array<float, kLobes> chance{};  ///< of each lobe
  };

  /// `o` turned by what the scales do to lobe p.
  Inclination turned(const Inclination& o, size_t p) const {
    if (p == kRest) return o;
    const Inclination& by = scales_.turn[p];
    return {o.sine * by.cosine + o.cosine * by.sine,
            std::abs(o.cosine * by.cosine - o.sine * by.sine)};
  }

  /// Density of lobe p per solid angle.
  float density(const Meeting& met, const Inclination& i, float phi, size_t p) const {
    const float along = along_density(i, turned(met.wo, p), variance_[p]);
    if (p == kRest) return along * (0.5F * kInvPi);
    return along * logistic(wrapped(phi - met.direction(p)), scale_) / share_;
  }

  Rgb scattered(const Vec3& wo, const Vec3& wi) const {
    const Meeting met(*this, wo);
    const Inclination i = inclination(wi);
    const float phi = atan2(wi.z, wi.y) - met.phi;
    Rgb sum(0.0F);
    for (size_t p = 0; p < kLobes; ++p) sum += met.light[p] * density(met, i, phi, p);
    return sum;
  }

  Rgb absorption_;
  float ior_;
  const Scales& scales_;                  ///< of the material
  std::array<float, kLobes> variance_{};  ///< of each lobe, along the strand
  float scale_ = 0.0F;                    ///< of the lobes' logistic distribution around it
  float share_ = 1.0F;
};

class Hair final : public Material {
 public:
  explicit Hair(HairParams params) : params_(std::move(params)) {
    // Scales lean away from the tip: what is mirrored is turned by twice their tilt towards the
    // root, what goes through by it and what is mirrored within by four times it the other way.
    constexpr std::array<float, 3> kTurns{2.0F, -1.0F, -4.0F};
    for (size_t p = 0; p < kTurns.size(); ++p) {
      const SinCos turn = sin_cos(kTurns[p] * params_.tilt * (kPi / 180.0F));
      scales_.turn[p] = {turn.sin, turn.cos};
    }
  }

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    const float radial = fraction_at(params_.radial_roughness, point);
    const Rgb absorption = params_.color
                               ? hair_absorption(reflectance_at(*params_.color, point), radial)
                               : params_.absorption;
    return arena.make<HairBsdf>(absorption, fraction_at(params_.roughness, point), radial,
                                params_.ior, scales_);
  }

 private:
  HairParams params_;
  Scales scales_{};
};

}  // namespace

MaterialPtr make_hair(const HairParams& params) { return std::make_shared<Hair>(params); }

Rgb melanin_absorption(float eumelanin, float pheomelanin) {
  return eumelanin * Rgb(0.419F, 0.697F, 1.37F) + pheomelanin * Rgb(0.187F, 0.4F, 1.05F);
}

Rgb hair_absorption(const Rgb& color, float radial_roughness) {
  const float n = radial_roughness;
  const float fit = 5.969F - 0.215F * n + 2.532F * powered(n, 2) - 10.73F * powered(n, 3) +
                    5.574F * powered(n, 4) + 0.245F * powered(n, 5);
  Rgb absorption;
  for (int c = 0; c < 3; ++c) {
    const float root = log(std::clamp(color[c], 1e-4F, 1.0F)) / fit;
    absorption[c] = root * root;
  }
  return absorption;
}

}  // namespace hyades::core
