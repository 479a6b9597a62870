#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/warp.h"
#include "core/materials/local.h"
#include "core/materials/make_matt.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

class DiffuseTransmissionBsdf final : public Bsdf {
 public:
  DiffuseTransmissionBsdf(const Rgb& color, const Rgb& transmitted)
      : color_(color), transmitted_(transmitted) {
    const float back = max_component(color);
    p_back_ = back / (back + max_component(transmitted));
  }

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    return (same_side(wo, wi) ? color_ : transmitted_) * (kInvPi * std::abs(wi.z));
  }

  Rgb evaluate_diffuse(const Vec3& wo, const Vec3& wi) const override {
    return same_side(wo, wi) ? color_ * (kInvPi * std::abs(wi.z)) : Rgb(0.0F);
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    return (same_side(wo, wi) ? p_back_ : 1.0F - p_back_) * (kInvPi * std::abs(wi.z));
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode) const override {
    const Vec3 i = square_to_cosine_hemisphere(u);
    const bool back = lobe < p_back_;
    const float p = back ? p_back_ : 1.0F - p_back_;
    BsdfSample s;
    s.pdf = p * cosine_hemisphere_pdf(i.z);
    if (!(s.pdf > 0.0F)) return std::nullopt;
    s.wi = {i.x, i.y, back ? i.z * side(wo) : -i.z * side(wo)};
    s.weight = (back ? color_ : transmitted_) / p;
    s.transmitted = !back;
    return s;
  }

  Spread spread(float) const override { return {.wide = color_, .wide_through = transmitted_}; }
  Rgb albedo(const Vec3&) const override { return color_ + transmitted_; }

 private:
  Rgb color_;
  Rgb transmitted_;
  float p_back_;
};

class DiffuseTransmission final : public Material {
 public:
  DiffuseTransmission(ColorParam color, ColorParam transmitted)
      : color_(std::move(color)), transmitted_(std::move(transmitted)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    Rgb color = reflectance_at(color_, point);
    Rgb transmitted = reflectance_at(transmitted_, point);
    const float most = max_component(color + transmitted);
    if (!(most > 0.0F)) return nullptr;
    if (most > 1.0F) {
      color /= most;
      transmitted /= most;
    }
    return arena.make<DiffuseTransmissionBsdf>(color, transmitted);
  }

 private:
  ColorParam color_;
  ColorParam transmitted_;
};

}  // namespace

MaterialPtr make_diffuse_transmission(const ColorParam& color, const ColorParam& transmitted) {
  return std::make_shared<DiffuseTransmission>(color, transmitted);
}

}  // namespace hyades::core
