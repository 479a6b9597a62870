#include "core/scene/transforms.h"

#include <cmath>

#include "core/base/elementary.h"

namespace hyades::core {
namespace {

constexpr float kRadians = kPi / 180.0F;

/// Rotation by `degrees` around `axis` (Rodrigues), counter-clockwise seen against the axis.
Mat4 rotation(const Vec3& axis, float degrees) {
  const float length = std::sqrt(glm::dot(axis, axis));
  if (length == 0.0F) return Mat4(1.0F);
  const Vec3 a = axis / length;
  const auto [s, c] = sin_cos(degrees * kRadians);
  const Vec3 k = a * (1.0F - c);
  Mat4 m(1.0F);
  m[0] = Vec4(c + k.x * a.x, k.x * a.y + s * a.z, k.x * a.z - s * a.y, 0.0F);
  m[1] = Vec4(k.y * a.x - s * a.z, c + k.y * a.y, k.y * a.z + s * a.x, 0.0F);
  m[2] = Vec4(k.z * a.x + s * a.y, k.z * a.y - s * a.x, c + k.z * a.z, 0.0F);
  return m;
}

Mat4 translation(const Vec3& offset) {
  Mat4 m(1.0F);
  m[3] = Vec4(offset, 1.0F);
  return m;
}

Mat4 step_matrix(const TransformStep& step, const JobTime& time) {
  using Kind = TransformStep::Kind;
  switch (step.kind) {
    case Kind::translate:
      return translation(step.vector.at(time));
    case Kind::scale: {
      const Vec3 s = step.vector.at(time);
      Mat4 m(1.0F);
      m[0].x = s.x;
      m[1].y = s.y;
      m[2].z = s.z;
      return m;
    }
    case Kind::rotate_x:
      return rotation({1.0F, 0.0F, 0.0F}, step.angle.at(time));
    case Kind::rotate_y:
      return rotation({0.0F, 1.0F, 0.0F}, step.angle.at(time));
    case Kind::rotate_z:
      return rotation({0.0F, 0.0F, 1.0F}, step.angle.at(time));
    case Kind::rotate:
      return rotation(step.vector.at(time), step.angle.at(time));
    case Kind::matrix:
      return step.matrix;
  }
  return Mat4(1.0F);
}

}  // namespace

Bounds transformed(const Mat4& m, const Bounds& box) {
  Bounds bounds;
  if (box.empty()) return bounds;
  for (int corner = 0; corner < 8; ++corner) {
    bounds.include(transform_point(m, {(corner & 1) != 0 ? box.upper.x : box.lower.x,
                                       (corner & 2) != 0 ? box.upper.y : box.lower.y,
                                       (corner & 4) != 0 ? box.upper.z : box.lower.z}));
  }
  return bounds;
}

Mat4 transform_at(const TransformList& steps, const Animated<Vec3>& at, const JobTime& time) {
  Mat4 m(1.0F);
  for (const TransformStep& step : steps) m = step_matrix(step, time) * m;
  return translation(at.at(time)) * m;
}

float largest_difference(const Mat4& a, const Mat4& b) {
  float largest = 0.0F;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) largest = std::max(largest, std::abs(a[c][r] - b[c][r]));
  }
  return largest;
}

}  // namespace hyades::core
