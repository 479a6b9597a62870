#include "import/pbrt/transforms.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace hyades::core::pbrt {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

}  // namespace

Parts parts_of(const Mat4d& m) {
  const glm::dmat3 linear(m);
  glm::dmat3 r = linear;
  for (int i = 0; i < 100; ++i) {
    const glm::dmat3 next = 0.5 * (r + glm::transpose(glm::inverse(r)));
    double change = 0.0;
    for (int c = 0; c < 3; ++c) change += glm::length(next[c] - r[c]);
    r = next;
    if (change < 1e-12) break;
  }
  if (glm::determinant(r) < 0.0) r = -r;  // what mirrors belongs to the stretch
  return {Vec3d(m[3]), glm::quat_cast(r), glm::transpose(r) * linear};
}

Mat4d translation(const Vec3d& by) { return glm::translate(Mat4d(1.0), by); }

Mat4d scaling(const Vec3d& by) { return glm::scale(Mat4d(1.0), by); }

Mat4d rotation(double degrees, const Vec3d& axis) {
  Mat4d turned = glm::rotate(Mat4d(1.0), degrees * kRadiansPerDegree, glm::normalize(axis));
  // Quarter turns about an axis are exact.
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      if (std::abs(turned[c][r]) < 1e-15) turned[c][r] = 0.0;
    }
  }
  return turned;
}

std::optional<Mat4d> look_at(const Vec3d& eye, const Vec3d& look, const Vec3d& up) {
  const Vec3d forward = glm::normalize(look - eye);
  const Vec3d across = glm::cross(glm::normalize(up), forward);
  if (!(glm::dot(across, across) > 0.0)) return std::nullopt;
  const Vec3d right = glm::normalize(across);
  const Vec3d top = glm::cross(forward, right);
  const Mat4d to_world(glm::dvec4(right, 0.0), glm::dvec4(top, 0.0), glm::dvec4(forward, 0.0),
                       glm::dvec4(eye, 1.0));
  return glm::inverse(to_world);
}

Mat4d from_columns(const double* numbers) {
  Mat4d m;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) m[c][r] = numbers[4 * c + r];
  }
  return m;
}

double linear_determinant(const Mat4d& m) { return glm::determinant(glm::dmat3(m)); }

bool is_placement(const Mat4d& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r]) || std::abs(m[c][r]) > 1e15) return false;
    }
    if (std::abs(m[c][3] - (c == 3 ? 1.0 : 0.0)) > 1e-9) return false;
  }
  const double determinant = linear_determinant(m);
  return std::isfinite(determinant) && determinant != 0.0;
}

Mat4d between(const Mat4d& a, const Mat4d& b, double u) {
  const Parts from = parts_of(a);
  const Parts to = parts_of(b);
  const glm::dquat turned = glm::slerp(from.rotation, to.rotation, u);
  const glm::dmat3 linear = glm::mat3_cast(turned) * ((1.0 - u) * from.stretch + u * to.stretch);
  Mat4d m(linear);
  m[3] = glm::dvec4(glm::mix(from.translation, to.translation, u), 1.0);
  return m;
}

}  // namespace hyades::core::pbrt
