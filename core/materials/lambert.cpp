#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/warp.h"
#include "core/materials/local.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

class LambertBsdf final : public Bsdf {
 public:
  explicit LambertBsdf(const Rgb& color) : color_(color) {}

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    return same_side(wo, wi) ? color_ * (kInvPi * std::abs(wi.z)) : Rgb(0.0F);
  }

  Rgb evaluate_diffuse(const Vec3& wo, const Vec3& wi) const override {
    return evaluate(wo, wi, TransportMode::radiance);
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    return same_side(wo, wi) ? kInvPi * std::abs(wi.z) : 0.0F;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float, const Vec2& u,
                                   TransportMode) const override {
    const Vec3 i = square_to_cosine_hemisphere(u);
    return BsdfSample{
        .weight = color_, .pdf = cosine_hemisphere_pdf(i.z), .wi = {i.x, i.y, i.z * side(wo)}};
  }

  Spread spread(float) const override { return {.wide = color_}; }
  Rgb albedo(const Vec3&) const override { return color_; }

 private:
  Rgb color_;
};

class Lambert final : public Material {
 public:
  explicit Lambert(ColorParam color) : color_(std::move(color)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    const Rgb color = reflectance_at(color_, point);
    return is_black(color) ? nullptr : arena.make<LambertBsdf>(color);
  }

  bool diffuses_evenly() const override { return true; }

 private:
  ColorParam color_;
};

}  // namespace

MaterialPtr make_lambert(const ColorParam& color) { return std::make_shared<Lambert>(color); }

}  // namespace hyades::core
