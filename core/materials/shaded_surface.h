#pragma once

#include <cmath>
#include <optional>

#include "core/materials/material.h"

namespace hyades::core {

/// A BSDF in world space with the geometric normal's say: directions on different sides of the
/// geometric and the shading normal carry nothing (light must not leak through), and importance
/// gets the adjoint correction of shading normals (Veach 1997, section 5.3).
class ShadedSurface {
 public:
  /// `point` outlives the surface.
  ShadedSurface(const SurfacePoint& point, const Material& material, BsdfArena& arena)
      : point_(point), frame_(Frame::around(point.ns, point.dpdu)) {
    bsdf_ = material.bsdf_at(point, frame_, arena);
  }

  ShadedSurface(const SurfacePoint&& point, const Material& material, BsdfArena& arena) = delete;

  const SurfacePoint& point() const { return point_; }
  const Frame& frame() const { return frame_; }
  const Bsdf* bsdf() const { return bsdf_; }  ///< null: black, and not to be asked anything
  bool has_smooth() const { return bsdf_ != nullptr && bsdf_->has_smooth(); }

  /// f |cos theta_i|, with wo and wi in world space.
  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    if (!consistent(wo) || !consistent(wi)) return Rgb(0.0F);
    const Rgb value = bsdf_->evaluate(frame_.to_local(wo), frame_.to_local(wi), mode);
    return mode == TransportMode::importance ? value * adjoint_factor(wo, wi) : value;
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    return bsdf_->pdf(frame_.to_local(wo), frame_.to_local(wi), mode);
  }

  /// sample with wi in world space.
  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const {
    if (!consistent(wo)) return std::nullopt;
    auto s = bsdf_->sample(frame_.to_local(wo), lobe, u, mode);
    if (!s) return std::nullopt;
    s->wi = glm::normalize(frame_.to_world(s->wi));
    if (!consistent(s->wi)) return std::nullopt;
    if (mode == TransportMode::importance) s->weight *= adjoint_factor(wo, s->wi);
    return s;
  }

 private:
  bool consistent(const Vec3& w) const {
    return glm::dot(w, point_.ng) * glm::dot(w, frame_.n) > 0.0F;
  }

  float adjoint_factor(const Vec3& wo, const Vec3& wi) const {
    const float below = std::abs(glm::dot(wo, point_.ng) * glm::dot(wi, frame_.n));
    const float above = std::abs(glm::dot(wo, frame_.n) * glm::dot(wi, point_.ng));
    return below > 0.0F ? above / below : 0.0F;
  }

  const SurfacePoint& point_;  ///< of the caller, which outlives this
  Frame frame_;
  const Bsdf* bsdf_ = nullptr;
};

}  // namespace hyades::core
