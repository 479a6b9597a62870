#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "core/geometry/curve_set.h"
#include "core/geometry/mesh.h"

namespace hyades::core {

/// A surface in object space: a mesh, one of the quadrics that are intersected exactly, or strands
/// of hair.
struct Shape {
  /// Angles turn around +y from +x towards -z; u = angle / 2pi, in [0, 1).
  enum class Kind {
    mesh,      ///< UVs of the mesh; (0, 0) where it has none
    sphere,    ///< around the origin; v = angle from -y / pi: 0 at -y, 1 at +y
    disk,      ///< in the plane y = 0 around the origin, normal +y; v = r / radius
    cylinder,  ///< open tube around the y axis, y in [0, height], normal outwards; v = y / height
    curves,    ///< u = 0 at the roots of strands, 1 at their tips; v as around a cylinder's axis
  };
  Kind kind = Kind::mesh;
  std::shared_ptr<const TriangleMesh> mesh;  ///< when the shutter opens
  /// Where the mesh deforms while the shutter is open: one of the same topology (same_topology)
  /// that it moves towards, every vertex on a straight line; when the shutter closes it has come
  /// `reach` of the way. Null: it keeps its form.
  std::shared_ptr<const TriangleMesh> next;
  float reach = 1.0F;  ///< above 0, at most 1
  std::shared_ptr<const CurveSet> curves;
  float radius = 1.0F;
  float height = 1.0F;

  bool deforms() const { return next != nullptr; }

  /// The corners of triangle `primitive` of the mesh at shutter time `time`, in object space.
  std::array<Vec3d, 3> corners_at(uint32_t primitive, float time) const;
};

/// Whether both list the same triangles of as many vertices, and both or none have normals: then
/// one can become the other.
bool same_topology(const TriangleMesh& a, const TriangleMesh& b);

/// Over the whole shutter interval.
Bounds bounds_of(const Shape& shape);

/// Rectangle in the plane y = 0, centred, `size` = extent along x and z, normal +y, uv 0..1. Two
/// triangles.
std::shared_ptr<TriangleMesh> make_rectangle(const Vec2& size);

/// Box centred on the origin, normals outwards, uv 0..1 per face. Twelve triangles.
std::shared_ptr<TriangleMesh> make_box(const Vec3& size);

}  // namespace hyades::core
