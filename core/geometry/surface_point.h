#pragma once

#include <cstdint>

#include "core/base/ray.h"
#include "core/base/vec.h"

namespace hyades::core {

struct CurveSet;
struct TriangleMesh;

/// A point on a surface, in world space.
struct SurfacePoint {
  Vec3 position{0.0F};
  Vec3 ng{0.0F, 0.0F, 1.0F};  ///< geometric normal, unit, outward (the shape's own orientation)
  Vec3 ns{0.0F, 0.0F, 1.0F};  ///< shading normal, unit, same side as ng
  Vec3 dpdu{1.0F, 0.0F, 0.0F};
  Vec3 dpdv{0.0F, 1.0F, 0.0F};
  /// The way that normal maps take for that of growing u: smooth over meshes that have
  /// TriangleMesh::tangents; zero: dpdu is it.
  Vec3 tangent{0.0F};
  Vec2 uv{0.0F};
  float t = 0.0F;     ///< distance along the ray that found it
  float time = 0.0F;  ///< shutter time 0..1
  /// Distance along +-ng beyond which rays no longer meet this surface [length].
  float clearance = 0.0F;
  /// Of strands: how far their other side is, where rays against ng begin [length]; else 0.
  float thickness = 0.0F;
  uint32_t object = 0;     ///< index of the placement
  uint32_t primitive = 0;  ///< index of the triangle or of the strand's piece; 0 for quadrics
  /// What the triangle belongs to, for the attributes of its corners (mesh_attributes.h); null for
  /// what is no mesh. Lives as long as the world does.
  const TriangleMesh* mesh = nullptr;
  const CurveSet* curves = nullptr;  ///< what a strand belongs to; as `mesh`
  Vec2 barycentrics{0.0F};  ///< of corners 1 and 2; of strands x is the place along the piece, 0..1
  float outside_index =
      1.0F;  ///< of refraction, of what is on the side of ng; who goes there knows
  Mat4 world_to_object{1.0F};  ///< at `time`
};

/// `p` moved off its surface by its clearance, to the side that `direction` points to: through
/// strands, which are thin.
Vec3 offset_position(const SurfacePoint& p, const Vec3& direction);

/// A ray that starts at `p`, on the side of it that `direction` (unit) points to, without meeting
/// p's own surface again; it keeps the shutter time of `p`, as all rays from surfaces do.
Ray spawn_ray(const SurfacePoint& p, const Vec3& direction, float t_max = kInfinity);

/// A ray from `p` to just before `target`: what a shadow test between two points needs. It ends
/// eight times `target_clearance` early (and a millionth of its length). Where the target was
/// already moved off its surface (offset_position), pass 0.
Ray spawn_ray_to(const SurfacePoint& p, const Vec3& target, float target_clearance);

/// A ray from a place in space to just before `target`, which has been moved off its surface.
Ray ray_between(const Vec3& from, const Vec3& target, float time);

/// A ray from `p` to `target`, both moved off their surfaces: exact at grazing angles too.
Ray spawn_ray_to(const SurfacePoint& p, const SurfacePoint& target);

}  // namespace hyades::core
