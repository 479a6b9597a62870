#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

/// How much of a surface a pixel covers, so that textures can be read no finer than that. It is a
/// function of the place alone, as if the camera saw it directly, and not of the path that found it
/// (pbrt-v4, Camera::Approximate_dp_dxy), so that every integrator reads the same texture.
namespace hyades::core {

/// What one pixel covers around a place.
struct PixelCone {
  Vec3 direction{0.0F};  ///< unit, from the camera to the place
  float width = 0.0F;    ///< of a pixel there, across the direction [length]; 0: a point
};

/// Who sees a place; cameras do. Immutable and thread-safe.
class PixelView {
 public:
  virtual ~PixelView() = default;

  /// A pixel around `point` at shutter time `time`; of places outside of the picture, and behind,
  /// by their distance.
  virtual PixelCone pixel_at(const Vec3& point, float time) const = 0;
};

/// Axes of the ellipse that is read of a surface, in full; `major` is at least as long as `minor`.
struct PixelSpan {
  Vec3 major{0.0F};
  Vec3 minor{0.0F};
};

/// Part of a pixel's width that is read. Samples lie all over a pixel (and its neighbours, by the
/// film's filter) and blur again what they read: whole pixels would blur twice.
inline constexpr float kSpanPerPixel = 0.5F;

/// What of the surface with unit normal `normal` is read for `cone`.
inline PixelSpan span_on_surface(const PixelCone& cone, const Vec3& normal) {
  constexpr float kLeastCosine = 1e-4F;
  const float width = kSpanPerPixel * cone.width;
  const float cosine = glm::dot(normal, cone.direction);
  // Along the surface, the way on which the cone is drawn out; any where it is met straight on.
  Vec3 along = cone.direction - cosine * normal;
  float length2 = glm::dot(along, along);
  if (!(length2 > 1e-12F)) {
    along = std::abs(normal.x) < 0.7F ? Vec3(1.0F, 0.0F, 0.0F) : Vec3(0.0F, 1.0F, 0.0F);
    along -= glm::dot(along, normal) * normal;
    length2 = glm::dot(along, along);
  }
  along /= std::sqrt(length2);
  return {along * (width / std::max(std::abs(cosine), kLeastCosine)),
          glm::cross(normal, along) * width};
}

}  // namespace hyades::core
