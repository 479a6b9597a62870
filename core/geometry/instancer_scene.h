#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry/affine.h"
#include "core/geometry/embree.h"
#include "core/geometry/placed_object.h"
#include "core/geometry/point_instancer.h"
#include "core/geometry/world.h"

namespace hyades::core {

class EmbreeWorld;

/// Copies of a small world, as one geometry of Embree whose primitives are the copies: each ray
/// that comes near one is transformed, and traced in the world that is copied. Debian's Embree has
/// one level of instances, of half a kilobyte each; this takes a fifth of that, and what is copied
/// may hold instances in its turn.
class InstancerScene {
 public:
  /// `members` are the placements of `instancer`, in their order; `inner` is the world of them.
  InstancerScene(std::shared_ptr<const PointInstancer> instancer, std::vector<Placement> members,
                 std::shared_ptr<const EmbreeWorld> inner);

  /// Builds Embree's scene. Once.
  Status build();

  bool is_of(const PointInstancer& instancer, const std::vector<Placement>& members) const;

  CopyPose pose(uint32_t copy, float time) const;
  const EmbreeWorld& inner() const { return *inner_; }
  const Motion& motion() const { return motion_; }
  RTCScene scene() const { return scene_->handle(); }
  Bounds bounds() const { return bounds_; }
  /// The bounds, over all copies, of what has the bounds `inner` in each.
  Bounds bounds_of(const Bounds& inner) const;
  size_t memory() const;  ///< bytes of places, of Embree's scene and of the world that is copied

 private:
  Bounds bounds_of_copy(uint32_t copy, size_t step, const Bounds& inner) const;

  static void bounds_callback(const RTCBoundsFunctionArguments* args);
  static void intersect_callback(const RTCIntersectFunctionNArguments* args);
  static void occluded_callback(const RTCOccludedFunctionNArguments* args);

  std::shared_ptr<const PointInstancer> instancer_;
  std::vector<Placement> members_;
  std::shared_ptr<const EmbreeWorld> inner_;
  Motion motion_;  ///< of the instancer as a whole
  std::shared_ptr<const EmbreeScene> scene_;
  Bounds bounds_;
};

/// A instancer in a world: its members are the placements from `first` on.
struct PlacedInstancer {
  uint32_t first = 0;
  std::shared_ptr<const InstancerScene> scene;
};

/// What a instancer's hit says besides Embree's numbers: which copy, and which of its objects.
struct CopyHit {
  uint32_t copy = 0;
  uint32_t object = 0;
};
CopyHit copy_hit(const RTCHit& hit);

}  // namespace hyades::core
