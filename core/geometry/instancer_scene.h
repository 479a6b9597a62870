#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry/affine.h"
#include "core/geometry/placed_object.h"
#include "core/geometry/point_instancer.h"
#include "core/geometry/ray_scene.h"
#include "core/geometry/world.h"

namespace hyades::core {

class PlacedWorld;

/// Copies of a small world, as a scene whose primitives are the copies: each ray that comes near
/// one is transformed, and traced in the world that is copied, which may hold instances in its
/// turn.
class InstancerScene {
 public:
  /// `members` are the placements of `instancer`, in their order; `inner` is the world of them.
  InstancerScene(std::shared_ptr<const PointInstancer> instancer, std::vector<Placement> members,
                 std::shared_ptr<const PlacedWorld> inner);

  /// Builds the scene by `builder`, which is of the inner world's kind. Once.
  Status build(SceneBuilder& builder);

  bool is_of(const PointInstancer& instancer, const std::vector<Placement>& members) const;

  CopyPose pose(uint32_t copy, float time) const;
  const PlacedWorld& inner() const { return *inner_; }
  const Motion& motion() const { return motion_; }
  const RayScene& scene() const { return *scene_; }
  uint32_t copy_count() const { return static_cast<uint32_t>(instancer_->places->size()); }
  Bounds bounds() const { return bounds_; }
  /// The bounds, over all copies, of what has the bounds `inner` in each.
  Bounds bounds_of(const Bounds& inner) const;
  /// The bounds, in one copy at a step of motion(), of what has the bounds `inner` in it.
  Bounds bounds_of_copy(uint32_t copy, size_t step, const Bounds& inner) const;
  size_t memory() const;  ///< bytes of places, of the scene and of the world that is copied

 private:
  std::shared_ptr<const PointInstancer> instancer_;
  std::vector<Placement> members_;
  std::shared_ptr<const PlacedWorld> inner_;
  Motion motion_;  ///< of the instancer as a whole
  std::shared_ptr<const RayScene> scene_;
  Bounds bounds_;
};

/// An instancer in a world: its members are the placements from `first` on.
struct PlacedInstancer {
  uint32_t first = 0;
  std::shared_ptr<const InstancerScene> scene;
};

}  // namespace hyades::core
