#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "core/base/ray.h"
#include "core/base/render_class.h"
#include "core/base/result.h"
#include "core/geometry/placed_object.h"

namespace hyades::core {

class InstancerScene;

/// Where rays begin: a scene counts hits at this distance, and those at 0 are not wanted.
inline constexpr float kNearest = std::numeric_limits<float>::min();

/// A mask that all rays meet.
inline constexpr unsigned kAllRays = 0xFFFFFFFFU;

/// What a ray met in a scene: numbers, from which the point is computed again.
struct SceneHit {
  uint32_t number = 0;     ///< of the geometry in the scene, as it was added
  uint32_t inner = 0;      ///< where that is an instance: of the geometry in the scene of it
  uint32_t primitive = 0;  ///< triangle, piece of a strand, or 0
  uint32_t copy = 0;       ///< where copies of an instancer were met: which
  uint32_t copied = 0;     ///< and what in it: the placement within the instancer's world
  double t = 0.0;          ///< how far away: about (Embree), or exactly what decided
};

/// Surfaces that rays are traced through, ready and immutable: either Embree's or a hierarchy of
/// our own.
class RayScene {
 public:
  virtual ~RayScene() = default;

  /// The nearest surface seen by rays of `kind` beyond the distance `t_min`, before `ray.t_max`.
  virtual std::optional<SceneHit> nearest(const Ray& ray, RayKind kind, float t_min) const = 0;

  /// Whether anything that blocks light lies on the ray.
  virtual bool occluded(const Ray& ray) const = 0;

  virtual size_t memory() const = 0;  ///< bytes of its geometries and hierarchy
};

/// Fills a scene. What is handed over by reference must outlive the scene at its address. `mask`
/// has a bit for each RayKind that sees the geometry; `number` is what hits name it by.
class SceneBuilder {
 public:
  virtual ~SceneBuilder() = default;

  virtual void add_mesh(const MeshBuffers& buffers, unsigned mask, uint32_t number) = 0;
  virtual void add_curves(const CurveSet& curves, unsigned mask, uint32_t number) = 0;
  virtual void add_quadric(const PlacedObject& object, unsigned mask, uint32_t number) = 0;

  /// `scene`, of the mesh or strands of `object`, where that stands.
  virtual void add_instance(const RayScene& scene, const PlacedObject& object, unsigned mask,
                            uint32_t number) = 0;

  /// `scene` as it is. All rays see what they see in it.
  virtual void add_scene(const RayScene& scene, uint32_t number) = 0;

  /// The copies of an instancer, as a scene of nothing else.
  virtual void add_copies(const InstancerScene& copies) = 0;

  /// The finished scene. Errors: no memory.
  virtual Result<std::shared_ptr<const RayScene>> commit() = 0;
};

/// A builder of scenes of one kind. One at a time may be in use in a process.
std::unique_ptr<SceneBuilder> make_scene_builder(RenderClass which);

}  // namespace hyades::core
