#pragma once

#include <algorithm>
#include <cmath>

#include "jobs/generator/mesh_writer.h"

/// Distance fields of bodies made of limbs.
namespace hyades::gallery {

/// Two distances as one, flowing into each other over `width`: Quilez, "smooth minimum"
/// (polynomial).
inline float joined(float a, float b, float width) {
  const float h = std::max(width - std::abs(a - b), 0.0F) / width;
  return std::min(a, b) - 0.25F * h * h * width;
}

/// Distance, about, to a limb: balls whose radius goes from ra at `a` to rb at `b`.
inline float limb(const Vec3& p, const Vec3& a, const Vec3& b, float ra, float rb) {
  const Vec3 along = b - a;
  const float h = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0F, 1.0F);
  return glm::length(p - (a + along * h)) - (ra + (rb - ra) * h);
}

/// Distance, about, to an ellipsoid around `c`.
inline float ellipsoid(const Vec3& p, const Vec3& c, const Vec3& r) {
  const float k = glm::length((p - c) / r);
  const float slope = glm::length((p - c) / (r * r));
  return slope > 0.0F ? k * (k - 1.0F) / slope : -std::min(r.x, std::min(r.y, r.z));
}

/// The distance from `p` to a body under construction.
class Body {
 public:
  explicit Body(const Vec3& p) : p_(p) {}

  void add(const Vec3& a, const Vec3& b, float ra, float rb, float flow = 0.04F) {
    distance_ = joined(distance_, limb(p_, a, b, ra, rb), flow);
  }
  void add(const Vec3& center, const Vec3& radii, float flow = 0.03F) {
    distance_ = joined(distance_, ellipsoid(p_, center, radii), flow);
  }
  float distance() const { return distance_; }

 private:
  Vec3 p_;
  float distance_ = 1e3F;
};

}  // namespace hyades::gallery
