#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "core/base/mutex.h"
#include "core/geometry/placed_object.h"
#include "core/geometry/ray_scene.h"
#include "core/geometry/world.h"

namespace hyades::core {

class InstancerScene;

/// A mesh or strands in their object space: what instances refer to.
struct MeshScene {
  std::shared_ptr<const MeshBuffers> buffers;  ///< null for strands
  std::shared_ptr<const CurveSet> curves;      ///< null for meshes
  std::shared_ptr<const RayScene> scene;
};

/// A placement made ready, under its number in the world.
struct NumberedObject {
  uint32_t number = 0;
  std::shared_ptr<const PlacedObject> object;
};

/// Still geometry in world space that frames share.
struct StillScene {
  std::vector<NumberedObject> objects;
  std::shared_ptr<const RayScene> scene;
};

/// What a MeshScene is of: the mesh, and what it deforms to; or the strands.
struct MeshKey {
  const TriangleMesh* mesh = nullptr;
  const CurveSet* curves = nullptr;
  const TriangleMesh* next = nullptr;
  float reach = 1.0F;
  auto operator<=>(const MeshKey&) const = default;
};

inline MeshKey mesh_key(const Shape& shape) {
  return {shape.mesh.get(), shape.curves.get(), shape.next.get(),
          shape.deforms() ? shape.reach : 1.0F};
}

/// What worlds have made that the next one may use again.
struct MadeGeometry {
  std::map<MeshKey, std::weak_ptr<const MeshScene>> meshes;
  std::weak_ptr<const StillScene> still;
  std::vector<std::weak_ptr<const InstancerScene>> instancers;
  /// What the last world used, so that it outlives that world.
  std::vector<std::shared_ptr<const void>> recent;
};

struct GeometryCache::State {
  Mutex mutex;  ///< held while a world is built
  MadeGeometry native HYADES_GUARDED_BY(mutex);
  MadeGeometry portable HYADES_GUARDED_BY(mutex);
};

}  // namespace hyades::core
