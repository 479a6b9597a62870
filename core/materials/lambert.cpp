#include <cmath>

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

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    return same_side(wo, wi) ? kInvPi * std::abs(wi.z) : 0.0F;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float, const Vec2& u,
                                   TransportMode) const override {
    Vec3 wi = cosine_hemisphere(u);
    const float density = kInvPi * wi.z;
    if (!(density > 0.0F)) return std::nullopt;
    wi.z *= side(wo);
    return BsdfSample{.weight = color_, .pdf = density, .wi = wi};
  }

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

 private:
  ColorParam color_;
};

}  // namespace

MaterialPtr make_lambert(const ColorParam& color) { return std::make_shared<Lambert>(color); }

}  // namespace hyades::core
