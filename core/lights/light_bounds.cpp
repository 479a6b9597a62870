#include "core/lights/light_bounds.h"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.h"

namespace hyades::core {
namespace {

/// Between unit vectors, good near 0 and pi too (Kahan, "How Futile are Mindless Assessments of
/// Roundoff").
float angle_between(const Vec3& a, const Vec3& b) {
  const Vec3 d = glm::dot(a, b) >= 0.0F ? a - b : a + b;
  const float half = asin(0.5F * std::sqrt(glm::dot(d, d)));
  return glm::dot(a, b) >= 0.0F ? 2.0F * half : kPi - 2.0F * half;
}

}  // namespace

DirectionCone join(const DirectionCone& a, const DirectionCone& b) {
  if (a.cosine <= -1.0F) return a;
  if (b.cosine <= -1.0F) return b;
  const float angle_a = acos(a.cosine);
  const float angle_b = acos(b.cosine);
  const float between = angle_between(a.axis, b.axis);
  if (between + angle_b <= angle_a) return a;
  if (between + angle_a <= angle_b) return b;
  constexpr float kRounding = 1e-5F;
  const float angle = 0.5F * (angle_a + between + angle_b) + kRounding;
  if (angle >= kPi) return {};
  const Vec3 across = b.axis - a.axis * glm::dot(a.axis, b.axis);
  const float length = std::sqrt(glm::dot(across, across));
  if (!(length > 1e-6F)) {  // the same axis, or opposite ones: either serves
    return {a.axis, cos(std::min(angle + std::abs(angle_a - angle_b) + between, kPi))};
  }
  const SinCos turn = sin_cos(angle - angle_a);
  return {glm::normalize(a.axis * turn.cos + across * (turn.sin / length)), cos(angle)};
}

void LightBounds::set_power(float flux) {
  power = flux > 0.0F ? std::min(flux, 1e37F) : 0.0F;
  intensity = power / std::max(orientation_measure(*this), 1e-6F);
}

LightBounds join(const LightBounds& a, const LightBounds& b) {
  LightBounds both = a;
  both.box.include(b.box);
  both.normals = join(a.normals, b.normals);
  both.cos_beyond = std::min(a.cos_beyond, b.cos_beyond);
  both.two_sided = a.two_sided || b.two_sided;
  both.power = a.power + b.power;
  both.intensity = a.intensity + b.intensity;
  return both;
}

float orientation_measure(const LightBounds& bounds) {
  const float spread = acos(bounds.normals.cosine);
  const float reach = std::min(spread + acos(bounds.cos_beyond), kPi);
  const float sine = sin(spread);
  const float solid_angle =
      2.0F * kPi * (1.0F - bounds.normals.cosine) +
      0.5F * kPi *
          (2.0F * (reach - spread) * sine - cos(spread - 2.0F * reach) + bounds.normals.cosine);
  return solid_angle * (bounds.two_sided ? 2.0F : 1.0F);
}

}  // namespace hyades::core
