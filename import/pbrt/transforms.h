#pragma once

#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "import/pbrt/scene.h"

namespace hyades::core::pbrt {

Mat4d translation(const Vec3d& by);
Mat4d scaling(const Vec3d& by);
/// About an axis of any length but zero, by degrees.
Mat4d rotation(double degrees, const Vec3d& axis);

/// World -> camera, whose x is right, y up and z forward (cross(up, forward) is right, as in
/// left-handed axes). Nothing where the three say no direction.
std::optional<Mat4d> look_at(const Vec3d& eye, const Vec3d& look, const Vec3d& up);

/// Of 16 numbers column by column, as the file has them.
Mat4d from_columns(const double* numbers);

/// Whether it can be undone: every number finite, determinant not 0, last row 0, 0, 0, 1.
bool is_placement(const Mat4d& m);

double linear_determinant(const Mat4d& m);

/// A transform taken apart: stretched (and mirrored), then turned, then moved.
struct Parts {
  Vec3d translation;
  glm::dquat rotation;
  glm::dmat3 stretch;
};

/// By polar decomposition (Shoemake and Duff 1992), by Higham's iteration (1986).
Parts parts_of(const Mat4d& m);

/// Between two transforms, u from 0 to 1: translation and scale linearly, rotation along the
/// shortest arc, as animated transforms are decomposed (Shoemake and Duff 1992).
Mat4d between(const Mat4d& a, const Mat4d& b, double u);

}  // namespace hyades::core::pbrt
