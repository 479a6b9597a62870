#pragma once

#include <cmath>
#include <optional>

#include "core/base/frame.h"
#include "core/materials/bsdf.h"
#include "core/materials/local.h"

namespace hyades::core {

/// A BSDF around a shading normal `n` that leans away from the normal `ng` of the surface. The BSDF
/// knows nothing of the surface: it throws light below its horizon, and half of it may not be seen
/// from above. Both are folded, so that uniform light comes back as bright as from the BSDF alone,
/// however far n leans:
///
///   what it throws to a direction below the horizon is reflected there by a mirror along the
///   surface: wi = i - 2 (i ng) ng;
///   who looks at its back, w ng > 0 > w n, sees it in an upright mirror behind it:
///   o = w - 2 (w t) t, t = n - (n ng) ng (the wall of Schuessler, Heitz, Hanika and Dachsbacher
///   2017, "Microfacet-based normal mapping for robust Monte Carlo path tracing").
///
/// Radiance is scattered so; importance by the adjoint of it per projected solid angle of the
/// surface (Veach 1997, section 5.3), for f (o, i) |i n| is not symmetric. All directions that come
/// and go are in the coordinates of n, ng and the frame, and unit.
class ShadingNormalCorrection {
 public:
  /// `frame`: that of the BSDF, around n.
  ShadingNormalCorrection(const Vec3& ng, const Frame& frame)
      : ng_(ng), frame_(frame), c_(glm::dot(ng, frame.n)), wall_(frame.n - c_ * ng) {
    const float length2 = glm::dot(wall_, wall_);
    leans_ = length2 > 0.0F;
    if (leans_) wall_ /= std::sqrt(length2);
  }

  const Frame& frame() const { return frame_; }

  Rgb evaluate(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    const auto value = [&](const Vec3& o, const Vec3& i) { return bsdf.evaluate(o, i, mode); };
    return mode == TransportMode::radiance ? scattered(wo, wi, value) : gathered(wo, wi, value);
  }

  /// The diffuse part of evaluate() of radiance.
  Rgb evaluate_diffuse(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) const {
    return scattered(wo, wi,
                     [&](const Vec3& o, const Vec3& i) { return bsdf.evaluate_diffuse(o, i); });
  }

  float pdf(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, TransportMode mode) const;

  /// Chooses a direction for `wo` as Bsdf::sample() does, with its weight and density after the
  /// correction.
  std::optional<BsdfSample> sample(const Bsdf& bsdf, const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const;

  Rgb albedo(const Bsdf& bsdf, const Vec3& wo) const {
    return bsdf.albedo(seen(wo, Cosines(*this, wo)));
  }

 private:
  /// With the surface's and with the BSDF's normal.
  struct Cosines {
    Cosines(const ShadingNormalCorrection& of, const Vec3& w)
        : surface(glm::dot(w, of.ng_)), bsdf(glm::dot(w, of.frame_.n)) {}
    bool agree() const { return surface * bsdf > 0.0F; }
    float surface;
    float bsdf;
  };

  /// The directions, of the BSDF, whose light goes to one direction of the surface: at most itself
  /// and its mirror image below the surface. They share one cosine with the surface's normal.
  struct Sources {
    int count = 0;
    Vec3 direction[2];
    float cosine[2];  ///< with n, without sign
  };

  bool folded(const Cosines& c) const {
    return leans_ && (c.bsdf - 2.0F * c.surface * c_) * c.surface > 0.0F;
  }
  Vec3 below(const Vec3& w, const Cosines& c) const { return w - 2.0F * c.surface * ng_; }

  Sources sources_of(const Vec3& w) const {
    const Cosines c(*this, w);
    Sources s;
    if (c.agree()) {
      s.direction[0] = w;
      s.cosine[0] = std::abs(c.bsdf);
      s.count = 1;
    }
    if (folded(c)) {
      s.direction[s.count] = below(w, c);
      s.cosine[s.count] = std::abs(c.bsdf - 2.0F * c.surface * c_);
      ++s.count;
    }
    return s;
  }

  /// `w` in the upright mirror.
  Vec3 behind(const Vec3& w) const { return w - 2.0F * glm::dot(w, wall_) * wall_; }

  /// The direction from which the BSDF is seen by who looks from `w`, in its frame.
  Vec3 seen(const Vec3& w, const Cosines& c) const {
    return frame_.to_local(c.agree() ? w : behind(w));
  }

  /// How many directions see the BSDF as from the direction that `c` sees it from.
  float onlookers(const Cosines& c) const {
    const float there = c.agree() ? 2.0F * c_ * c.surface - c.bsdf : c.bsdf;
    return leans_ && !(there * c.surface > 0.0F) ? 2.0F : 1.0F;
  }

  template <class Value>
  Rgb scattered(const Vec3& wo, const Vec3& wi, const Value& value) const {
    const Vec3 o = seen(wo, Cosines(*this, wo));
    const Sources from = sources_of(wi);
    Rgb sum(0.0F);
    for (int n = 0; n < from.count; ++n) sum += value(o, frame_.to_local(from.direction[n]));
    return sum;
  }

  /// f of radiance with its arguments exchanged, for projected solid angles of the surface.
  template <class Value>
  Rgb gathered(const Vec3& wo, const Vec3& wi, const Value& value) const {
    const Cosines out(*this, wo);
    const Cosines in(*this, wi);
    const Vec3 i = seen(wi, in);
    const float under = std::abs(out.surface * i.z);
    if (!(under > 0.0F)) return Rgb(0.0F);
    const Sources from = sources_of(wo);
    Rgb sum(0.0F);
    for (int n = 0; n < from.count; ++n)
      sum += value(frame_.to_local(from.direction[n]), i) * from.cosine[n];
    return sum * (std::abs(in.surface) / under);
  }

  std::optional<BsdfSample> sample_radiance(const Bsdf& bsdf, const Vec3& wo, float lobe,
                                            const Vec2& u) const;
  std::optional<BsdfSample> sample_importance(const Bsdf& bsdf, const Vec3& wo, float lobe,
                                              const Vec2& u) const;
  std::optional<BsdfSample> weighed(const Bsdf& bsdf, const Vec3& wo, BsdfSample sample,
                                    TransportMode mode) const;

  Vec3 ng_;
  Frame frame_;
  float c_;    ///< of the angle between both normals
  Vec3 wall_;  ///< the unit normal t of the upright mirror; 0 where the normals are the same
  bool leans_;
};

}  // namespace hyades::core
