#pragma once

#include "core/base/vec.h"

/// Small geometry in the local frame of a BSDF, where z is the shading normal.
namespace hyades::core {

inline bool same_side(const Vec3& a, const Vec3& b) { return a.z * b.z > 0.0F; }

/// The mirror direction of `w` about z.
inline Vec3 mirrored(const Vec3& w) { return {-w.x, -w.y, w.z}; }

/// The sign that turns a two-sided surface so that `w` lies above: multiply z with it.
inline float side(const Vec3& w) { return w.z < 0.0F ? -1.0F : 1.0F; }

/// Index of the side beyond the surface over that of the side of `wo`, where that of z < 0 over
/// that of z > 0 is `ior`.
inline float index_beyond(const Vec3& wo, float ior) { return wo.z >= 0.0F ? ior : 1.0F / ior; }

/// `w` on the upper side.
inline Vec3 above(const Vec3& w) { return {w.x, w.y, w.z < 0.0F ? -w.z : w.z}; }

/// Stretches what is left of a random number after it fell into [begin, begin + width) to [0, 1).
inline float rest_of(float u, float begin, float width) {
  const float rest = (u - begin) / width;
  return rest < 0x1.fffffep-1F ? rest : 0x1.fffffep-1F;
}

}  // namespace hyades::core
