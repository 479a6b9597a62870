#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/elementary.h"
#include "core/base/warp.h"
#include "core/materials/local.h"
#include "core/materials/make_matt.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

/// Portsmouth, Kutz and Hill 2024: single scattering is Fujii's form of Oren and Nayar, scaled so
/// that its albedo is at most 1 (equations 9 to 12), and a lobe gives back what it lacks (18, 19).
class RoughMattBsdf final : public Bsdf {
 public:
  RoughMattBsdf(const Rgb& color, float roughness)
      : color_(color), r_(roughness), a_(1.0F / (1.0F + (0.5F - 2.0F / (3.0F * kPi)) * roughness)) {
    mean_ = std::fmin(a_ * (1.0F + (2.0F / 3.0F - 28.0F / (15.0F * kPi)) * r_), 1.0F);
    if (!(mean_ < 1.0F)) return;
    lost_ = color * color * (mean_ / (1.0F - mean_)) / (Rgb(1.0F) - color * (1.0F - mean_));
  }

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    if (!same_side(wo, wi)) return Rgb(0.0F);
    const Vec3 o = above(wo);
    const Vec3 i = above(wi);
    const float s = o.x * i.x + o.y * i.y;
    const float bend = s > 0.0F ? s / std::fmax(o.z, i.z) : s;
    const float single = a_ * (1.0F + r_ * bend);
    return (color_ * single + lost_ * (lack(o.z) * lack(i.z))) * (kInvPi * i.z);
  }

  Rgb evaluate_diffuse(const Vec3& wo, const Vec3& wi) const override {
    return evaluate(wo, wi, TransportMode::radiance);
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    return same_side(wo, wi) ? kInvPi * std::abs(wi.z) : 0.0F;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float, const Vec2& u,
                                   TransportMode mode) const override {
    const Vec3 i = square_to_cosine_hemisphere(u);
    BsdfSample s;
    s.pdf = cosine_hemisphere_pdf(i.z);
    s.wi = {i.x, i.y, i.z * side(wo)};
    if (!(s.pdf > 0.0F)) return std::nullopt;
    s.weight = evaluate(wo, s.wi, mode) / s.pdf;
    return s;
  }

  Spread spread(float) const override {
    return {.wide = color_ * mean_ + lost_ * ((1.0F - mean_) * (1.0F - mean_))};
  }

  Rgb albedo(const Vec3& wo) const override {
    const float missing = lack(std::abs(wo.z));
    return color_ * (1.0F - missing) + lost_ * missing;
  }

 private:
  /// 1 - the albedo of single scattering (equation 14).
  float lack(float cosine) const {
    const float sine = std::sqrt(std::fmax(0.0F, 1.0F - cosine * cosine));
    // (1 - sin^3) / cos, in a form without a pole.
    const float steep = cosine * (1.0F + sine + sine * sine) / (1.0F + sine);
    const float g = sine * (acos(std::fmin(cosine, 1.0F)) - sine * cosine) +
                    (2.0F / 3.0F) * (sine * steep - sine);
    return std::fmax(0.0F, 1.0F - a_ * (1.0F + r_ * kInvPi * g));
  }

  Rgb color_;
  float r_;
  float a_;
  float mean_ = 1.0F;  ///< over the hemisphere, of single scattering's albedo
  Rgb lost_{0.0F};     ///< times both lacks: what light does that single scattering lacks
};

class RoughMatt final : public Material {
 public:
  RoughMatt(ColorParam color, ScalarParam roughness)
      : color_(std::move(color)), roughness_(std::move(roughness)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    const Rgb color = reflectance_at(color_, point);
    if (is_black(color)) return nullptr;
    return arena.make<RoughMattBsdf>(color, fraction_at(roughness_, point));
  }

 private:
  ColorParam color_;
  ScalarParam roughness_;
};

}  // namespace

MaterialPtr make_rough_matt(const ColorParam& color, const ScalarParam& roughness) {
  if (!roughness.texture && !(roughness.value > 0.0F)) return make_lambert(color);
  return std::make_shared<RoughMatt>(color, roughness);
}

}  // namespace hyades::core
