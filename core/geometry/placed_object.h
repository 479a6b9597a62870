#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/ray.h"
#include "core/geometry/affine.h"
#include "core/geometry/mesh_buffers.h"
#include "core/geometry/quadric.h"
#include "core/geometry/world.h"

namespace hyades::core {

/// A placement made ready for intersection: what was found by Embree is computed again here, in
/// double precision from the primitive and the ray.
class PlacedObject {
 public:
  /// A quadric, or a mesh that `buffers` holds in world or object space.
  PlacedObject(Placement placement, std::shared_ptr<const MeshBuffers> buffers);

  const Placement& placement() const { return placement_; }
  const MeshBuffers* buffers() const { return buffers_.get(); }  ///< null for quadrics
  const Motion& motion() const { return motion_; }
  const Quadric& quadric() const { return quadric_; }
  bool is_quadric() const { return placement_.shape.kind != Shape::Kind::mesh; }

  Affine to_world_at(float time) const { return motion_.still() ? to_world_ : motion_.at(time); }
  Affine to_object_at(float time) const {
    return motion_.still() ? to_object_ : motion_.at(time).inverse();
  }

  /// Where the ray's line meets triangle `primitive` (or the quadric: u = v = 0), as distance along
  /// the ray and barycentrics. Nothing where it does not, by this arithmetic.
  std::optional<Hit> meet(const Ray& ray, uint32_t primitive) const;

  /// The point of a hit.
  SurfacePoint point(const Ray& ray, const Hit& hit) const;

  /// The point of a mesh at barycentrics (u, v) of triangle `primitive`.
  SurfacePoint mesh_point(uint32_t primitive, float u, float v, float time) const;

  Bounds bounds() const { return bounds_; }

 private:
  SurfacePoint quadric_surface(const Ray& ray, const Hit& hit) const;
  bool in_world() const { return buffers_ != nullptr && buffers_->in_world; }

  Placement placement_;
  std::shared_ptr<const MeshBuffers> buffers_;
  Motion motion_;
  Affine to_world_;   // where still
  Affine to_object_;  // where still
  Mat4 world_to_object_{1.0F};
  Quadric quadric_;
  Bounds bounds_;
};

/// World bounds of a box in object space under `m`, rounded outwards.
Bounds transform_bounds(const Affine& m, const Bounds& box);

/// World bounds of a quadric under `m`: tight, rounded outwards.
Bounds quadric_bounds(const Affine& m, const Shape& shape);

}  // namespace hyades::core
