#include "core/scene/transforms.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/elementary.h"

namespace hyades::core {
namespace {

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

/// Of a unit quaternion (x, y, z, w).
Mat4 rotation(const Vec4& q) {
  const Vec3 v(q);
  const Vec3 twice = 2.0F * v;
  Mat4 m(1.0F);
  m[0] = Vec4(1.0F - twice.y * v.y - twice.z * v.z, twice.x * v.y + twice.z * q.w,
              twice.x * v.z - twice.y * q.w, 0.0F);
  m[1] = Vec4(twice.x * v.y - twice.z * q.w, 1.0F - twice.x * v.x - twice.z * v.z,
              twice.y * v.z + twice.x * q.w, 0.0F);
  m[2] = Vec4(twice.x * v.z + twice.y * q.w, twice.y * v.z - twice.x * q.w,
              1.0F - twice.x * v.x - twice.y * v.y, 0.0F);
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
    case Kind::quaternion:
      return rotation(rotation_at(step.quaternion, time));
    case Kind::matrix:
      return step.matrix;
  }
  return Mat4(1.0F);
}

constexpr int kMostSteps = kMostShutterMoments - 1;
/// Steps that are always looked at, so that what comes back to where it was is noticed.
constexpr int kFirstSteps = kShutterMoments - 1;
constexpr float kTolerance = 1e-4F;

float largest_linear(const Mat4& m) {
  float largest = 0.0F;
  for (int c = 0; c < 3; ++c) largest = std::max(largest, max_component(glm::abs(Vec3(m[c]))));
  return largest;
}

/// Whether every second of `fine`, or only one of `stride`, says the others as well.
bool is_enough(const std::vector<Mat4>& fine, size_t stride) {
  float linear = 0.0F;
  float moved = 0.0F;
  for (const Mat4& m : fine) {
    linear = std::max(linear, largest_linear(m));
    moved = std::max(moved, max_component(glm::abs(Vec3(m[3] - fine[0][3]))));
  }
  const float translation = std::max(linear, moved);
  for (size_t i = 0; i + 1 < fine.size(); ++i) {
    const size_t base = i / stride * stride;
    const float w = static_cast<float>(i - base) / static_cast<float>(stride);
    const Mat4 error = fine[base] * (1.0F - w) + fine[base + stride] * w - fine[i];
    if (largest_linear(error) > kTolerance * linear) return false;
    if (max_component(glm::abs(Vec3(error[3]))) > kTolerance * translation) return false;
  }
  return true;
}

}  // namespace

bool is_animated(const TransformList& steps) {
  return std::any_of(steps.begin(), steps.end(), [](const TransformStep& step) {
    return !step.vector.is_constant() || !step.angle.is_constant();
  });
}

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

std::vector<Mat4> sampled_matrices(const ShutterMatrix& matrix_at) {
  const auto sample = [&](int i, int steps) {
    return matrix_at(static_cast<float>(i) / static_cast<float>(steps));
  };
  int steps = kFirstSteps;
  std::vector<Mat4> fine;
  for (int i = 0; i <= steps; ++i) fine.push_back(sample(i, steps));
  if (std::all_of(fine.begin(), fine.end(), [&](const Mat4& m) { return m == fine[0]; }))
    return {fine[0]};
  while (steps < kMostSteps) {
    // Twice as many tell whether those that there are were enough.
    std::vector<Mat4> finer;
    for (int i = 0; i < 2 * steps; ++i)
      finer.push_back(i % 2 == 0 ? fine[static_cast<size_t>(i / 2)] : sample(i, 2 * steps));
    finer.push_back(fine.back());
    fine = std::move(finer);
    steps *= 2;
    if (is_enough(fine, 2)) break;
  }
  for (size_t stride = static_cast<size_t>(steps); stride > 1; stride /= 2) {
    if (!is_enough(fine, stride)) continue;
    std::vector<Mat4> coarse;
    for (size_t i = 0; i < fine.size(); i += stride) coarse.push_back(fine[i]);
    return coarse;
  }
  return fine;
}

}  // namespace hyades::core
