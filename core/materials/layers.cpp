#include <cmath>
#include <memory>
#include <utility>

#include "core/base/elementary.h"
#include "core/materials/layered_bsdf.h"
#include "core/materials/make_layers.h"
#include "core/materials/params.h"
#include "core/materials/turned_bsdf.h"
#include "core/materials/wrapped_material.h"

namespace hyades::core {
namespace {

/// Bouguer's law for light that goes through a coat twice: `color` is left of what goes straight in
/// and out, less on longer ways.
class CoatTint {
 public:
  CoatTint(const Rgb& color, float eta) : eta_(eta), clear_(color == Rgb(1.0F)) {
    // 1e-6: what is black stays black to any eye.
    for (int k = 0; k < 3; ++k) half_log_[k] = 0.5F * log(std::fmax(color[k], 1e-6F));
  }

  Rgb at(const Vec3& wo, const Vec3& wi) const {
    if (clear_) return Rgb(1.0F);
    const float way = way_of(wo) + way_of(wi);
    return {exp(half_log_.x * way), exp(half_log_.y * way), exp(half_log_.z * way)};
  }

 private:
  /// Over the coat's thickness.
  float way_of(const Vec3& w) const {
    const float cosine2 = 1.0F - (1.0F - w.z * w.z) / (eta_ * eta_);
    return 1.0F / std::sqrt(std::fmax(cosine2, 1e-4F));
  }

  float eta_;
  bool clear_;
  Rgb half_log_{0.0F};
};

class Coat final : public WrappedMaterial {
 public:
  Coat(MaterialPtr base, const CoatParams& params)
      : WrappedMaterial(std::move(base)), params_(params) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame& frame, BsdfArena& arena) const override {
    const Bsdf* beneath = bsdf_in_frame(base(), point, frame, arena);
    const float amount = fraction_at(params_.amount, point);
    const float eta = params_.ior / point.outside_index;
    if (!(amount > 0.0F)) return beneath;
    const float roughness = fraction_at(params_.roughness, point);
    const CoatLobe lobe(amount, eta, roughness * roughness);
    const Rgb color = reflectance_at(params_.color, point);
    const CoatTint tint(Rgb(1.0F) + (color - Rgb(1.0F)) * amount, eta);
    return arena.make<LayeredBsdf<CoatLobe, CoatTint>>(lobe, tint, beneath, leads_inside(),
                                                       base().diffuses_evenly());
  }
  bool is_null() const override { return false; }
  bool diffuses_evenly() const override { return false; }

 private:
  CoatParams params_;
};

class Sheen final : public WrappedMaterial {
 public:
  Sheen(MaterialPtr base, ColorParam color, ScalarParam roughness)
      : WrappedMaterial(std::move(base)),
        color_(std::move(color)),
        roughness_(std::move(roughness)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame& frame, BsdfArena& arena) const override {
    const Bsdf* beneath = bsdf_in_frame(base(), point, frame, arena);
    const Rgb color = reflectance_at(color_, point);
    if (is_black(color)) return beneath;
    return arena.make<LayeredBsdf<FuzzLobe, NoTint>>(
        FuzzLobe(color, fraction_at(roughness_, point)), NoTint(), beneath, leads_inside(),
        base().diffuses_evenly());
  }
  bool is_null() const override { return false; }
  bool diffuses_evenly() const override { return false; }

 private:
  ColorParam color_;
  ScalarParam roughness_;
};

}  // namespace

MaterialPtr make_coat(MaterialPtr base, const CoatParams& params) {
  return std::make_shared<Coat>(std::move(base), params);
}

MaterialPtr make_sheen(MaterialPtr base, const ColorParam& color, const ScalarParam& roughness) {
  return std::make_shared<Sheen>(std::move(base), color, roughness);
}

}  // namespace hyades::core
