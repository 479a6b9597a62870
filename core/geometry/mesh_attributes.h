#pragma once

#include <array>
#include <optional>

#include "core/geometry/surface_point.h"

/// What the corners of triangles, and the points of strands, carry besides their place, at a point
/// of a surface.
namespace hyades::core {

/// The interpolated colour, linear Rec.709 and alpha; nothing where the surface has none.
std::optional<Vec4> vertex_color(const SurfacePoint& point);

/// How it changes over the triangle: its derivatives by x, y and z of the place in object space,
/// along the triangle. 0 where there is none, or the triangle is degenerate.
std::array<Vec4, 3> vertex_color_gradient(const SurfacePoint& point);

/// The second set of texture coordinates; (0, 0) where there is none.
Vec2 second_uv(const SurfacePoint& point);

/// How the second set changes over the triangle: its derivatives by the place in object space,
/// along the triangle. 0 where there is none, or the triangle is degenerate.
std::array<Vec3, 2> second_uv_gradient(const SurfacePoint& point);

/// Whether, by the tangents of the mesh's file, growing v lies on the other side than
/// cross(normal, tangent), as the surface stands in the world. Nothing where there are none.
std::optional<bool> file_tangent_mirrored(const SurfacePoint& point);

}  // namespace hyades::core
