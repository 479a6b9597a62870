#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/ray.h"
#include "core/cameras/camera.h"
#include "core/geometry/mesh.h"

namespace hyades::core {

struct Scene;

/// Where surfaces are in the next frame (the motion layer): transforms and cameras at the moments
/// when the shutters of this frame and of the next one open.
struct FilmMotion {
  std::unique_ptr<Camera> camera;  ///< of this frame, through the middle of the lens
  std::unique_ptr<Camera> next_camera;
  std::vector<Mat4> to_world;  ///< by placement, in the next frame
  /// By placement, what its mesh is in the next frame; null: the same, or one of other triangles,
  /// whose places are not known.
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;

  /// How far a point of placement `object`, on its triangle `primitive`, at `position` at shutter
  /// time `time`, moves over the film from this frame to the next: pixels, x to the right, y up.
  /// Nothing was met (kNoObject): what is infinitely far along `ray` (0 for cameras whose rays are
  /// parallel). On panoramas the shorter way, also beyond their edges. 0 where either frame has it
  /// behind the camera.
  Vec2 of(const Scene& scene, uint32_t object, uint32_t primitive, const Vec3& position,
          const Ray& ray, float time) const;
};

}  // namespace hyades::core
