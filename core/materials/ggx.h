#pragma once

#include <cmath>

#include "core/base/vec.h"
#include "core/base/warp.h"

namespace hyades::core {

/// How wide GGX facets lean, alike in all directions.
struct EvenWidth {
  float alpha = 1.0F;  ///< kLeastAlpha .. 1

  /// Density of facets with normal along `h`, which need not be of unit length.
  float density(const Vec3& h) const {
    const float a2 = alpha * alpha;
    const float across = h.x * h.x + h.y * h.y;
    const float stretched = across + a2 * h.z * h.z;
    // Opposite horizontal directions have no half vector.
    if (!(stretched > 0.0F)) return 0.0F;
    const float ratio = (across + h.z * h.z) / stretched;
    return a2 * kInvPi * (ratio * ratio);
  }

  /// sqrt(z^2 + alpha^2 sin^2) = z (1 + 2 Lambda(w)), without its pole at grazing angles.
  float spread(const Vec3& w) const {
    return std::sqrt(w.z * w.z + alpha * alpha * (w.x * w.x + w.y * w.y));
  }

  /// `w` where facets are stretched to a hemisphere.
  Vec3 stretched(const Vec3& w) const { return {alpha * w.x, alpha * w.y, w.z}; }
};

/// Facets with a width each along x and y (Heitz 2014, equations 85 and 87).
struct TwoWidths {
  float along_x = 1.0F;  ///< kLeastAlpha .. 1
  float along_y = 1.0F;

  float density(const Vec3& h) const {
    const float x = h.x * along_y;
    const float y = h.y * along_x;
    const float both = along_x * along_y;
    const float stretched = x * x + y * y + both * both * h.z * h.z;
    if (!(stretched > 0.0F)) return 0.0F;
    const float ratio = both * glm::dot(h, h) / stretched;
    return both * kInvPi * (ratio * ratio);
  }

  float spread(const Vec3& w) const {
    const float x = along_x * w.x;
    const float y = along_y * w.y;
    return std::sqrt(w.z * w.z + x * x + y * y);
  }

  Vec3 stretched(const Vec3& w) const { return {along_x * w.x, along_y * w.y, w.z}; }

  /// The even width that facets have as seen from `w`.
  float seen_from(const Vec3& w) const {
    const float across = w.x * w.x + w.y * w.y;
    if (!(across > 0.0F)) return std::sqrt(along_x * along_y);
    const float x = along_x * w.x;
    const float y = along_y * w.y;
    return std::sqrt((x * x + y * y) / across);
  }
};

/// GGX microfacets (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces")
/// with height-correlated Smith masking (Heitz 2014, "Understanding the Masking-Shadowing
/// Function", equation 99). Directions are local, above the surface (z > 0) unless said otherwise.
/// Single scattering only: light that would hit a second facet is lost.
template <class Width>
struct GgxFacets : Width {
  /// Below this the lobe is narrower than what float directions resolve: use a delta lobe.
  static constexpr float kLeastAlpha = 1e-4F;

  using Width::density;
  using Width::spread;

  /// G1: the part of the facets' projected area that `w` sees.
  float visible(const Vec3& w) const { return 2.0F * w.z / (w.z + spread(w)); }

  /// G2: what both directions see (equation 99).
  float both_visible(const Vec3& a, const Vec3& b) const {
    return 2.0F * a.z * b.z / (a.z * spread(b) + b.z * spread(a));
  }

  /// f cos(theta_i) of facets that reflect everything: D G2 / (4 cos theta_o).
  float reflect(const Vec3& wo, const Vec3& wi) const {
    return density(wo + wi) * 0.5F * wi.z / (wo.z * spread(wi) + wi.z * spread(wo));
  }

  /// Density of wi where a facet visible from wo is drawn by sample_normal() and reflects:
  /// G1 D / (4 cos theta_o) (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
  float reflect_pdf(const Vec3& wo, const Vec3& wi) const {
    return density(wo + wi) * 0.5F / (wo.z + spread(wo));
  }

  /// reflect() / reflect_pdf() = G2 / G1, free of the density's rounding; at most 1.
  float reflect_weight(const Vec3& wo, const Vec3& wi) const {
    const float o = spread(wo);
    return wi.z * (wo.z + o) / (wo.z * spread(wi) + wi.z * o);
  }

  /// A unit facet normal, drawn in proportion to its area as seen from wo. u in [0, 1)^2.
  /// Where facets are scaled to a hemisphere, that hemisphere reflects wo uniformly into a
  /// spherical cap (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps",
  /// listing 3).
  Vec3 sample_normal(const Vec3& wo, const Vec2& u) const {
    const Vec3 w = glm::normalize(this->stretched(wo));
    const Vec3 m = this->stretched(square_to_cone(u, 1.0F + w.z) + w);
    const float length2 = glm::dot(m, m);
    return length2 > 0.0F ? m / std::sqrt(length2) : Vec3(0.0F, 0.0F, 1.0F);
  }
};

using Ggx = GgxFacets<EvenWidth>;
using AnisotropicGgx = GgxFacets<TwoWidths>;

/// `w` reflected by a facet of unit normal `m`.
inline Vec3 reflected(const Vec3& w, const Vec3& m) { return 2.0F * glm::dot(w, m) * m - w; }

}  // namespace hyades::core
