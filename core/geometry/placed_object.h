#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/ray.h"
#include "core/geometry/affine.h"
#include "core/geometry/mesh_buffers.h"
#include "core/geometry/quadric.h"
#include "core/geometry/triangle.h"
#include "core/geometry/world.h"

namespace hyades::core {

/// Where a copy of an instancer stands at some moment, both ways.
struct CopyPose {
  Affine to_world;
  Affine to_copy;
};

/// A placement made ready for intersection: what was found by Embree is computed again here, in
/// double precision from the primitive and the ray.
class PlacedObject {
 public:
  /// A quadric, strands, or a mesh that `buffers` holds in world or object space.
  PlacedObject(Placement placement, std::shared_ptr<const MeshBuffers> buffers);

  const Placement& placement() const { return placement_; }
  const MeshBuffers* buffers() const { return buffers_.get(); }  ///< null but for meshes
  const Motion& motion() const { return motion_; }
  const Quadric& quadric() const { return quadric_; }
  bool is_quadric() const { return buffers_ == nullptr && !is_curves(); }
  bool is_curves() const { return placement_.shape.kind == Shape::Kind::curves; }

  Affine to_world_at(float time) const { return moves_ ? motion_.at(time) : to_world_; }
  Affine to_object_at(float time) const { return moves_ ? motion_.at(time).inverse() : to_object_; }

  /// `copy` in what follows: where the copy of an instancer stands that the object belongs to;
  /// null: the object stands in the world itself.

  /// Where the ray's line meets triangle `primitive` (or the quadric: u = v = 0; or piece
  /// `primitive` of a strand: u is the place along it), as distance along the ray and barycentrics.
  /// Nothing where it does not, by this arithmetic.
  std::optional<Hit> meet(const Ray& ray, uint32_t primitive, const CopyPose* copy = nullptr) const;

  /// The point of a hit.
  SurfacePoint point(const Ray& ray, const Hit& hit, const CopyPose* copy = nullptr) const;

  /// Both at once: the same bits for less work. False where the line does not meet it; `point` is
  /// then unchanged.
  bool meet(const Ray& ray, uint32_t primitive, SurfacePoint& point,
            const CopyPose* copy = nullptr) const;

  /// The point of a mesh at barycentrics (u, v) of triangle `primitive`.
  SurfacePoint mesh_point(uint32_t primitive, float u, float v, float time,
                          const CopyPose* copy = nullptr) const;

  /// The point of a quadric next to `near` (object space).
  SurfacePoint quadric_place(const Vec3d& near, float time) const;

  Bounds bounds() const { return bounds_; }  ///< in the world, or in the space of copies
  /// The box of the whole object at a step of motion(). Not for meshes in world space, whose
  /// vertices move instead.
  Bounds bounds_at_step(size_t step) const;

 private:
  /// Where it stands at some time.
  struct Pose {
    const Affine& to_world;
    const Affine& to_object;
    const Mat4& world_to_object;
    bool mirrors;  ///< turns the shape inside out
  };

  std::optional<Hit> meet_triangle_of(const Ray& ray, uint32_t primitive, const Triangle& triangle,
                                      const CopyPose* copy) const;
  void fill_mesh_point(SurfacePoint& p, const Hit& hit, const Triangle& triangle, float time,
                       const CopyPose* copy) const;
  void fill_mesh_point(SurfacePoint& p, const Hit& hit, const Triangle& triangle, const Pose& pose,
                       const CopyPose* copy) const;
  Vec3d mesh_normal(const std::array<uint32_t, 3>& vertices, double u, double v, float time) const;
  Vec3d mesh_tangent(uint32_t primitive, double u, double v, float time) const;
  /// Of strands. `point`, unless null, gets the place.
  std::optional<Hit> meet_piece(const Ray& ray, uint32_t primitive, const CopyPose* copy,
                                SurfacePoint* point) const;
  SurfacePoint quadric_surface(const Ray& ray, const Hit& hit, const CopyPose* copy) const;
  SurfacePoint quadric_place(const Vec3d& near, float time, const Affine& to_world,
                             const Affine& to_object) const;
  /// Triangle `primitive` in the space of the buffers.
  Triangle triangle_at(uint32_t primitive, float time) const {
    const std::array<uint32_t, 3>& t = indices_[primitive];
    if (vertices_move_) return Triangle(buffers_->moving_corners(t, time));
    return Triangle({Vec3d(positions_[t[0]]), Vec3d(positions_[t[1]]), Vec3d(positions_[t[2]])});
  }

  // First what every hit reads: few cache lines, for worlds of many objects.
  const std::array<uint32_t, 3>* indices_ = nullptr;
  const Vec3* positions_ = nullptr;
  const float* errors_ = nullptr;  ///< MeshBuffers::errors; null where there are none
  std::shared_ptr<const MeshBuffers> buffers_;
  bool in_world_ = false;
  bool vertices_move_ = false;
  bool moves_ = false;
  bool mirrors_ = false;  // where still
  Affine to_object_;      // where still
  Quadric quadric_;
  Motion motion_;
  Affine to_world_;  // where still
  Mat4 world_to_object_{1.0F};
  Placement placement_;
  Bounds bounds_;
};

/// World bounds of a box in object space under `m`, rounded outwards.
Bounds transform_bounds(const Affine& m, const Bounds& box);

/// World bounds of a quadric under `m`: tight, rounded outwards.
Bounds quadric_bounds(const Affine& m, const Shape& shape);

}  // namespace hyades::core
