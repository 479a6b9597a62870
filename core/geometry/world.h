#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/ray.h"
#include "core/base/render_class.h"
#include "core/base/result.h"
#include "core/geometry/point_instancer.h"
#include "core/geometry/shape.h"
#include "core/geometry/surface_point.h"

namespace hyades::core {

/// What a ray is, by where it comes from: a bit each, so that several make a set.
enum class RayKind : uint32_t {
  none = 0,
  camera = 1,        ///< straight from the lens
  diffuse = 2,       ///< reflected by the diffuse part of a surface
  glossy = 4,        ///< reflected by the rest of it, sharply too
  transmission = 8,  ///< sent through a surface
  volume = 16,       ///< scattered in a medium
  shadow = 32,       ///< between a place and a light
  scattered = 2 | 4 | 8 | 16,
  all = 63,
  occlusion = 64,  ///< World::occluded's own: what stands in the way of shadow rays for certain
};

constexpr RayKind operator|(RayKind a, RayKind b) {
  return static_cast<RayKind>(static_cast<uint32_t>(a) | static_cast<uint32_t>(b));
}
constexpr RayKind operator&(RayKind a, RayKind b) {
  return static_cast<RayKind>(static_cast<uint32_t>(a) & static_cast<uint32_t>(b));
}
/// Whether the sets have a kind in common.
constexpr bool meet(RayKind a, RayKind b) { return (a & b) != RayKind::none; }

/// A shape put into the world.
struct Placement {
  Shape shape;
  /// One matrix: still. More: object to world at equal steps over the shutter interval,
  /// interpolated linearly, element by element, between neighbours.
  std::vector<Mat4> to_world{Mat4(1.0F)};
  RayKind seen_by = RayKind::all;  ///< the rays that meet it
  bool blocks_light = true;        ///< false: occluded() looks through it (null materials, opacity)
  /// Whether neighbouring frames place it elsewhere or shape it otherwise: such placements are kept
  /// apart from the geometry that frames share. Decided by the job alone, never by which frames
  /// were built before, so that a frame's bits do not depend on them.
  bool changes_between_frames = false;
  /// Null: it stands once in the world. Else `to_world` leads into the space of the instancer's
  /// copies, each of which holds this and all neighbours in the list of placements with the same
  /// instancer.
  std::shared_ptr<const PointInstancer> instancer;
};

/// Whether both put the same things into the world, by address.
bool same_placement(const Placement& a, const Placement& b);

/// What a ray met: enough to find the surface point again.
struct Hit {
  uint32_t object = 0;  ///< index of the placement
  uint32_t primitive = 0;
  uint32_t copy = 0;  ///< index in PointInstancer::places; 0 where there is no instancer
  float t = 0.0F;     ///< recomputed with exact divisions: the same bits on every CPU
  float u = 0.0F;     ///< barycentric of vertex 1 (meshes)
  float v = 0.0F;     ///< barycentric of vertex 2 (meshes)
};

/// Acceleration structures that outlive a frame: one per distinct mesh that is instanced or moves,
/// keyed by the mesh's address, and one of the still geometry that frames share. Kept while a world
/// uses them, and those of the last world built until the next one is built. Thread-safe.
class GeometryCache {
 public:
  GeometryCache();
  ~GeometryCache();
  struct State;
  State& state() { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// All surfaces of one frame. Immutable and thread-safe; rays must be finite (NaN and infinity are
/// counted and miss). Beneath lies Embree at one pinned ISA, build quality and flag set, or a
/// hierarchy of our own: see docs/architecture.md.
class World {
 public:
  virtual ~World() = default;

  /// The nearest surface on the ray that is seen by (one of) `kind`, or nothing.
  virtual std::optional<Hit> intersect(const Ray& ray, RayKind kind) const = 0;

  /// Whether anything that blocks light lies on the ray, and shadow rays see it.
  virtual bool occluded(const Ray& ray) const = 0;

  /// Everything about the point that `ray` hit.
  virtual SurfacePoint surface(const Ray& ray, const Hit& hit) const = 0;

  /// The point of the nearest surface on the ray: intersect() and surface() in one, the same bits
  /// for less work. False, and `point` is unchanged, where there is none.
  virtual bool nearest(const Ray& ray, RayKind kind, SurfacePoint& point) const = 0;

  /// The surface point of placement `object` (of an instancer: in its first copy) at triangle
  /// `primitive`, barycentrics (u, v), shutter
  /// time `time`: what light sampling on a mesh needs.
  virtual SurfacePoint triangle_point(uint32_t object, uint32_t primitive, float u, float v,
                                      float time) const = 0;

  /// The surface point of placement `object`, a sphere, disk or cylinder, next to `near` (object
  /// space) at shutter time `time`: what light sampling on a quadric needs.
  virtual SurfacePoint quadric_point(uint32_t object, const Vec3& near, float time) const = 0;

  /// Object-to-world matrix of placement `object` at shutter time `time`; of an instancer's members
  /// that of the instancer as a whole.
  virtual Mat4 transform_at(uint32_t object, float time) const = 0;

  virtual const Placement& placement(uint32_t object) const = 0;
  /// Of placement `object` over the shutter interval, all of its copies.
  virtual Bounds bounds_of(uint32_t object) const = 0;
  virtual uint32_t placement_count() const = 0;
  virtual Bounds bounds() const = 0;  ///< over the whole shutter interval
  virtual size_t memory() const = 0;  ///< bytes of its hierarchies, and of copies of vertices

  /// How many rays were refused since the world was built: not finite, or out of any scene's reach.
  virtual uint64_t invalid_rays() const { return 0; }
};

/// Builds the world. Single still placements become direct geometry with world-space vertices;
/// large meshes that are placed several times, and meshes that move, become instances of a scene in
/// `cache`. Singular transforms are no error: meshes become flat, quadrics vanish. Errors: a
/// transform that is not finite, coordinates beyond 1e12, no memory; Embree without the pinned ISA.
Result<std::shared_ptr<const World>> build_world(std::vector<Placement> placements,
                                                 GeometryCache& cache,
                                                 RenderClass which = RenderClass::native);

}  // namespace hyades::core
