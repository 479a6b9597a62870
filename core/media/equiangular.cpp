#include "core/media/equiangular.h"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.h"

namespace hyades::core {
namespace {

/// A ray that passes nearer than this, in parts of its way there, is taken to pass at it.
constexpr float kLeastAngle = 1e-3F;

}  // namespace

Equiangular::Equiangular(const Ray& ray, float t_max, const Vec3& point) : t_max_(t_max) {
  const Vec3 to_point = point - ray.origin;
  nearest_ = glm::dot(to_point, ray.direction);
  const Vec3 across = to_point - nearest_ * ray.direction;
  const float reach = std::sqrt(glm::dot(to_point, to_point));
  distance_ = std::max(std::sqrt(glm::dot(across, across)), std::max(kLeastAngle * reach, 1e-12F));
  begin_ = atan2(-nearest_, distance_);
  const float end = t_max < kInfinity ? atan2(t_max - nearest_, distance_) : 0.5F * kPi;
  angle_ = std::max(end - begin_, 1e-12F);
}

float Equiangular::nearest() const { return std::clamp(nearest_, 0.0F, t_max_); }

float Equiangular::sample(float u) const {
  const float t = nearest_ + distance_ * tan(begin_ + u * angle_);
  return std::clamp(t, 0.0F, t_max_);
}

float Equiangular::pdf(float t) const {
  if (!(t >= 0.0F && t <= t_max_)) return 0.0F;
  const float along = t - nearest_;
  return distance_ / (angle_ * (distance_ * distance_ + along * along));
}

}  // namespace hyades::core
