#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/vec.h"

namespace hyades::core {

/// An affine map in double precision: p -> linear * p + offset. Hits and points are computed in
/// double from the float matrices of a placement, so that only the last rounding to float counts.
struct Affine {
  glm::dmat3 linear{1.0};
  Vec3d offset{0.0};

  Affine() = default;
  Affine(const glm::dmat3& l, const Vec3d& o) : linear(l), offset(o) {}
  explicit Affine(const Mat4& m) : linear(glm::dmat3(Mat3(m))), offset(Vec3d(Vec3(m[3]))) {}

  Vec3d point(const Vec3d& p) const { return linear * p + offset; }
  Vec3d vector(const Vec3d& v) const { return linear * v; }
  Affine operator*(const Affine& o) const { return {linear * o.linear, point(o.offset)}; }
  double determinant() const { return glm::determinant(linear); }

  /// The map back; all zeros where there is none.
  Affine inverse() const {
    const Vec3d a = linear[0];
    const Vec3d b = linear[1];
    const Vec3d c = linear[2];
    const Vec3d bc = glm::cross(b, c);
    const double scale = 1.0 / glm::dot(a, bc);
    if (!std::isfinite(scale)) return {glm::dmat3(0.0), Vec3d(0.0)};
    const glm::dmat3 inv =
        glm::transpose(glm::dmat3(bc * scale, glm::cross(c, a) * scale, glm::cross(a, b) * scale));
    return {inv, -(inv * offset)};
  }

  Mat4 to_mat4() const {
    return Mat4(Vec4(Vec3(linear[0]), 0.0F), Vec4(Vec3(linear[1]), 0.0F),
                Vec4(Vec3(linear[2]), 0.0F), Vec4(Vec3(offset), 1.0F));
  }
};

/// A place between two of several equal steps over the shutter interval.
struct StepPlace {
  size_t step;      ///< the earlier one; there is a next
  double fraction;  ///< of the way to the next, 0 to 1
};

/// Where `time` in [0, 1] falls among `count` steps, at least two.
inline StepPlace step_place(float time, size_t count) {
  const double place = static_cast<double>(time) * static_cast<double>(count - 1);
  const size_t i = std::min(static_cast<size_t>(std::max(place, 0.0)), count - 2);
  return {i, std::clamp(place - static_cast<double>(i), 0.0, 1.0)};
}

/// The matrices of a placement over the shutter interval.
class Motion {
 public:
  Motion() : steps_(1) {}
  explicit Motion(const std::vector<Mat4>& matrices) {
    for (const Mat4& m : matrices) steps_.emplace_back(m);
  }

  bool still() const { return steps_.size() == 1; }
  const std::vector<Affine>& steps() const { return steps_; }

  /// Object to world at `time` in [0, 1], interpolated element by element as Embree does.
  Affine at(float time) const {
    if (still()) return steps_[0];
    const auto [i, f] = step_place(time, steps_.size());
    const Affine& a = steps_[i];
    const Affine& b = steps_[i + 1];
    return {a.linear * (1.0 - f) + b.linear * f, a.offset * (1.0 - f) + b.offset * f};
  }

 private:
  std::vector<Affine> steps_;
};

}  // namespace hyades::core
