#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/geometry_cache.h"
#include "core/geometry/instancer_scene.h"
#include "core/geometry/ray_scene.h"
#include "core/geometry/world.h"

namespace hyades::core {

/// What a world is put together from; build_world fills it in.
struct WorldParts {
  std::vector<std::shared_ptr<const PlacedObject>> objects;
  std::vector<std::shared_ptr<const MeshScene>> mesh_scenes;  ///< distinct, in use
  std::shared_ptr<const StillScene> still;                    ///< null: all is in `top`
  std::vector<PlacedInstancer> instancers;
  std::shared_ptr<const RayScene> top;
};

/// The world over one scene. Geometry numbers in `top` are numbers of placements, but for
/// the still scene, an instance with the number after the last, and the
/// instancers, instances with the numbers after that.
class PlacedWorld final : public World {
 public:
  explicit PlacedWorld(WorldParts parts);

  std::optional<Hit> intersect(const Ray& ray, RayKind kind) const override;
  bool occluded(const Ray& ray) const override;
  SurfacePoint surface(const Ray& ray, const Hit& hit) const override;
  bool nearest(const Ray& ray, RayKind kind, SurfacePoint& point) const override;
  SurfacePoint quadric_point(uint32_t object, const Vec3& near, float time) const override;
  SurfacePoint triangle_point(uint32_t object, uint32_t primitive, float u, float v,
                              float time) const override;
  Mat4 transform_at(uint32_t object, float time) const override;
  const Placement& placement(uint32_t object) const override;
  uint32_t placement_count() const override;
  Bounds bounds() const override { return bounds_; }
  size_t memory() const override { return memory_; }
  uint64_t invalid_rays() const override { return invalid_rays_.load(); }
  Bounds bounds_of(uint32_t object) const override;

  const RayScene& scene() const { return *parts_.top; }
  /// The placement that a hit names, in a world without instancers.
  uint32_t object_of(const SceneHit& hit) const {
    return hit.number == still_number_ ? hit.inner : hit.number;
  }
  const std::vector<std::shared_ptr<const PlacedObject>>& objects() const { return parts_.objects; }

 private:
  bool usable(const Ray& ray) const;

  /// The instancer that placement `object` belongs to; null: none.
  const InstancerScene* instancer_of(uint32_t object) const;

  /// Hands what the scene finds along the ray to `take(placement, primitive, instancer, copy)`, the
  /// instancer null where the placement stands in the world itself, until it returns true; false
  /// where it never does.
  template <class Take>
  bool find_nearest(const Ray& ray, RayKind kind, Take&& take) const;

  WorldParts parts_;
  uint32_t still_number_;
  Bounds bounds_;
  size_t memory_ = 0;
  mutable std::atomic<uint64_t> invalid_rays_{0};
};

}  // namespace hyades::core
