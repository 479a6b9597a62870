#pragma once

#include "core/base/bounds.h"
#include "core/base/vec.h"

namespace hyades::core {

/// Unit directions at most an angle away from an axis.
struct DirectionCone {
  Vec3 axis{0.0F, 1.0F, 0.0F};  ///< unit
  float cosine = -1.0F;         ///< of the angle: -1 is all directions, 1 only the axis
};

/// A cone that holds both, at most a little larger than the smallest one.
DirectionCone join(const DirectionCone& a, const DirectionCone& b);

/// Where one or more finite lights are and where they shine while the shutter is open (Estevez &
/// Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", section 4.1).
struct LightBounds {
  Bounds box;               ///< of all places that give off light [m]
  DirectionCone normals;    ///< of their surfaces; of a spot the directions it shines in
  float cos_beyond = 0.0F;  ///< of how far from a normal light goes: 0 for surfaces, 1 for spots
  bool two_sided = false;   ///< shines along the opposites of the normals as well
  float power = 0.0F;       ///< flux as luminance [W]; greater than 0
  float intensity = 0.0F;   ///< flux per solid angle that it goes into [W/sr]; lights' are added up

  /// Of one light: finds its intensity. No power: none.
  void set_power(float flux);
};

/// Bounds of the lights of both.
LightBounds join(const LightBounds& a, const LightBounds& b);

/// The solid angle that light of such bounds goes into, directions far from the normals counting
/// less [sr]: pi of a flat lamp, 4 pi of a ball (Estevez & Kulla 2018, M_Omega of section 4.4).
float orientation_measure(const LightBounds& bounds);

/// max(cos(a - b), 0 <= b <= a ? that : 1): the cosine of what is left of angle a where it is
/// narrowed by b. Angles in [0, pi] by cosine and sine.
inline float cosine_narrowed(float cos_a, float sin_a, float cos_b, float sin_b) {
  return cos_a > cos_b ? 1.0F : cos_a * cos_b + sin_a * sin_b;
}

/// The sine of the same.
inline float sine_narrowed(float cos_a, float sin_a, float cos_b, float sin_b) {
  return cos_a > cos_b ? 0.0F : sin_a * cos_b - cos_a * sin_b;
}

}  // namespace hyades::core
