#pragma once

#include <optional>

#include "core/materials/material.h"
#include "core/materials/shading_normal_correction.h"

namespace hyades::core {

/// A BSDF in world space, with the geometric normal's say (ShadingNormalCorrection): light does not
/// leak through the surface, none is lost where the shading normal leans, and importance is the
/// adjoint of radiance.
class ShadedSurface {
 public:
  /// `point` outlives the surface.
  ShadedSurface(const SurfacePoint& point, const Material& material, BsdfArena& arena)
      : point_(point),
        bsdf_(nullptr),
        correction_(point.ng, framed(point, material, arena, bsdf_)) {}

  ShadedSurface(const SurfacePoint&& point, const Material& material, BsdfArena& arena) = delete;

  const SurfacePoint& point() const { return point_; }
  const Frame& frame() const { return correction_.frame(); }
  const Bsdf* bsdf() const { return bsdf_; }  ///< null: black, and not to be asked anything
  bool has_smooth() const { return bsdf_ != nullptr && bsdf_->has_smooth(); }

  /// f |cos theta_i|, with wo and wi in world space.
  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    return correction_.evaluate(*bsdf_, wo, wi, mode);
  }

  /// Which share of evaluate(wo, wi) is diffuse reflection, by channel: 0 to 1.
  Rgb diffuse_share(const Vec3& wo, const Vec3& wi) const {
    const Rgb all = evaluate(wo, wi, TransportMode::radiance);
    if (is_black(all)) return Rgb(0.0F);
    const Rgb diffuse = correction_.evaluate_diffuse(*bsdf_, wo, wi);
    Rgb share(0.0F);
    for (int c = 0; c < 3; ++c)
      share[c] = all[c] > 0.0F ? glm::clamp(diffuse[c] / all[c], 0.0F, 1.0F) : 0.0F;
    return share;
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    return correction_.pdf(*bsdf_, wo, wi, mode);
  }

  /// sample with wi in world space.
  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const {
    return correction_.sample(*bsdf_, wo, lobe, u, mode);
  }

  Rgb albedo(const Vec3& wo) const { return correction_.albedo(*bsdf_, wo); }

 private:
  /// The frame that the material gives its BSDF.
  static Frame framed(const SurfacePoint& point, const Material& material, BsdfArena& arena,
                      const Bsdf*& bsdf) {
    Frame frame = Frame::around(point.ns, point.dpdu);
    bsdf = material.bsdf_at(point, frame, arena);
    return frame;
  }

  const SurfacePoint& point_;  ///< of the caller, which outlives this
  const Bsdf* bsdf_;
  ShadingNormalCorrection correction_;
};

}  // namespace hyades::core
