#pragma once

#include <cmath>

#include "core/base/vec.h"

namespace hyades::core {

/// Right-handed orthonormal basis (s, t, n) with n = z of local coordinates.
struct Frame {
  Vec3 s{1.0F, 0.0F, 0.0F};
  Vec3 t{0.0F, 1.0F, 0.0F};
  Vec3 n{0.0F, 0.0F, 1.0F};

  /// Any basis around unit vector `n`, continuous except at n.z = 0 (Duff et al. 2017, "Building an
  /// Orthonormal Basis, Revisited", listing 3).
  static Frame around(const Vec3& n) {
    const float sign = std::copysign(1.0F, n.z);
    const float a = -1.0F / (sign + n.z);
    const float b = n.x * n.y * a;
    return {
        {1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }

  /// The basis around unit `n` whose s is `tangent` made orthogonal; any basis where tangent is
  /// parallel to n or zero.
  static Frame around(const Vec3& n, const Vec3& tangent) {
    const Vec3 s = tangent - n * glm::dot(n, tangent);
    const float length2 = glm::dot(s, s);
    if (!(length2 > 1e-12F * glm::dot(tangent, tangent))) return around(n);
    const Vec3 unit = s / std::sqrt(length2);
    return {unit, glm::cross(n, unit), n};
  }

  Vec3 to_local(const Vec3& v) const { return {glm::dot(v, s), glm::dot(v, t), glm::dot(v, n)}; }
  Vec3 to_world(const Vec3& v) const { return s * v.x + t * v.y + n * v.z; }
};

}  // namespace hyades::core
