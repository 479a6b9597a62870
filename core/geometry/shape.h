#pragma once

#include <memory>

#include "core/geometry/mesh.h"

namespace hyades::core {

/// A surface in object space: a mesh, or one of the quadrics that are intersected exactly.
struct Shape {
  /// Angles turn around +y from +x towards -z; u = angle / 2pi, in [0, 1).
  enum class Kind {
    mesh,      ///< UVs of the mesh; (0, 0) where it has none
    sphere,    ///< around the origin; v = angle from -y / pi: 0 at -y, 1 at +y
    disk,      ///< in the plane y = 0 around the origin, normal +y; v = r / radius
    cylinder,  ///< open tube around the y axis, y in [0, height], normal outwards; v = y / height
  };
  Kind kind = Kind::mesh;
  std::shared_ptr<const TriangleMesh> mesh;
  float radius = 1.0F;
  float height = 1.0F;
};

Bounds bounds_of(const Shape& shape);

/// Rectangle in the plane y = 0, centred, `size` = extent along x and z, normal +y, uv 0..1. Two
/// triangles.
std::shared_ptr<TriangleMesh> make_rectangle(const Vec2& size);

/// Box centred on the origin, normals outwards, uv 0..1 per face. Twelve triangles.
std::shared_ptr<TriangleMesh> make_box(const Vec3& size);

}  // namespace hyades::core
