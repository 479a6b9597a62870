#include "core/scene/scene_cache.h"

namespace hyades::core {
namespace {

bool same_placement(const Placement& a, const Placement& b) {
  return a.shape.kind == b.shape.kind && a.shape.mesh == b.shape.mesh &&
         a.shape.radius == b.shape.radius && a.shape.height == b.shape.height &&
         a.visible_to_camera == b.visible_to_camera && a.blocks_light == b.blocks_light &&
         a.to_world == b.to_world;
}

bool same_placements(const std::vector<Placement>& a, const std::vector<Placement>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_placement);
}

}  // namespace

Result<std::shared_ptr<const TriangleMesh>> SceneCache::mesh(const std::string& file,
                                                             const std::string& smooth) {
  const std::lock_guard lock(mutex_);
  auto& slot = meshes_[{file, smooth}];
  if (slot) return slot;
  auto loaded = read_mesh(assets_, file);
  if (!loaded) return loaded.error();
  const std::shared_ptr<TriangleMesh> mesh = *loaded;
  if (smooth == "flat") mesh->normals.clear();
  if (smooth == "smooth") compute_smooth_normals(*mesh);
  slot = mesh;
  return slot;
}

Result<std::shared_ptr<const Image>> SceneCache::image(const std::string& file, ColorSpace space) {
  const std::lock_guard lock(mutex_);
  auto& slot = images_[{file, space}];
  if (slot) return slot;
  auto bytes = assets_.open(file);
  if (!bytes) return bytes.error();
  auto loaded = read_image(*bytes, file, space);
  if (!loaded) return loaded.error();
  slot = std::make_shared<const Image>(std::move(*loaded));
  return slot;
}

Result<std::shared_ptr<const EnvironmentMap>> SceneCache::environment_map(const std::string& file) {
  auto picture = image(file, ColorSpace::automatic);
  if (!picture) return picture.error();
  const std::lock_guard lock(mutex_);
  auto& slot = environment_maps_[file];
  if (!slot) slot = std::make_shared<const EnvironmentMap>(*picture);
  return slot;
}

std::shared_ptr<const TriangleMesh> SceneCache::made_mesh(
    const std::string& key, std::shared_ptr<TriangleMesh> (*make)(const Vec3&), const Vec3& size) {
  const std::lock_guard lock(mutex_);
  auto& slot = meshes_[{key, "made"}];
  if (!slot) slot = make(size);
  return slot;
}

Result<std::shared_ptr<const World>> SceneCache::world(std::vector<Placement> placements) {
  const std::lock_guard lock(mutex_);
  if (world_ && same_placements(placements, world_placements_)) return world_;
  world_placements_ = placements;
  auto built = build_world(std::move(placements), geometry_);
  if (!built) {
    world_.reset();
    return built.error();
  }
  world_ = *built;
  return world_;
}

size_t SceneCache::image_memory() const {
  const std::lock_guard lock(mutex_);
  size_t bytes = 0;
  for (const auto& [key, image] : images_) {
    if (image) bytes += image->data.size() * sizeof(float);
  }
  return bytes;
}

}  // namespace hyades::core
