#pragma once

#include <optional>

#include "core/materials/material.h"
#include "core/materials/shading_normal_correction.h"

namespace hyades::core {

/// A BSDF whose normal was turned (by a bump map), or that was turned around it, away from the one
/// its directions are given in.
class TurnedBsdf final : public Bsdf {
 public:
  /// `turn`: the inner frame's axes in outer local coordinates.
  TurnedBsdf(const Bsdf& inner, const Frame& turn)
      : inner_(inner), correction_(Vec3(0.0F, 0.0F, 1.0F), turn) {}

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    return correction_.evaluate(inner_, wo, wi, mode);
  }
  Rgb evaluate_diffuse(const Vec3& wo, const Vec3& wi) const override {
    return correction_.evaluate_diffuse(inner_, wo, wi);
  }
  float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    return correction_.pdf(inner_, wo, wi, mode);
  }
  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override {
    return correction_.sample(inner_, wo, lobe, u, mode);
  }
  Rgb albedo(const Vec3& wo) const override { return correction_.albedo(inner_, wo); }
  Spread spread(float outer) const override { return inner_.spread(outer); }
  bool has_smooth() const override { return inner_.has_smooth(); }

 private:
  const Bsdf& inner_;
  ShadingNormalCorrection correction_;
};

/// The BSDF of a part of another material, which keeps its own frame `outer`.
inline const Bsdf* bsdf_in_frame(const Material& part, const SurfacePoint& point,
                                 const Frame& outer, BsdfArena& arena) {
  Frame inner = outer;
  const Bsdf* bsdf = part.bsdf_at(point, inner, arena);
  if (bsdf == nullptr || (inner.n == outer.n && inner.s == outer.s)) return bsdf;
  return arena.make<TurnedBsdf>(
      *bsdf, Frame{outer.to_local(inner.s), outer.to_local(inner.t), outer.to_local(inner.n)});
}

}  // namespace hyades::core
