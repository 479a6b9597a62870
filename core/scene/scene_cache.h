#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/base/assets.h"
#include "core/geometry/read_mesh.h"
#include "core/geometry/world.h"
#include "core/image/read_image.h"
#include "core/lights/environment_map.h"

namespace hyades::core {

/// What the frames of a job share: meshes, images, acceleration structures, and the whole world
/// while nothing in it moves. Thread-safe: the next frame's scene loads while this one renders.
class SceneCache {
 public:
  explicit SceneCache(AssetResolver& assets) : assets_(assets) {}

  /// A mesh file with its normals as `smooth` asks: "file", "flat" or "smooth".
  Result<std::shared_ptr<const TriangleMesh>> mesh(const std::string& file,
                                                   const std::string& smooth);

  Result<std::shared_ptr<const Image>> image(const std::string& file, ColorSpace space);

  /// An image as a sky, ready to be sampled.
  Result<std::shared_ptr<const EnvironmentMap>> environment_map(const std::string& file);

  /// A mesh made here (rectangle, box), shared between equal requests under `key`.
  std::shared_ptr<const TriangleMesh> made_mesh(const std::string& key,
                                                std::shared_ptr<TriangleMesh> (*make)(const Vec3&),
                                                const Vec3& size);

  /// The world of `placements`; the previous one where they are the same.
  Result<std::shared_ptr<const World>> world(std::vector<Placement> placements);

  size_t image_memory() const;

 private:
  AssetResolver& assets_;
  mutable std::mutex mutex_;
  // Guarded by mutex_.
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const TriangleMesh>> meshes_;
  std::map<std::pair<std::string, ColorSpace>, std::shared_ptr<const Image>> images_;
  std::map<std::string, std::shared_ptr<const EnvironmentMap>> environment_maps_;
  std::vector<Placement> world_placements_;
  std::shared_ptr<const World> world_;
  GeometryCache geometry_;
};

}  // namespace hyades::core
