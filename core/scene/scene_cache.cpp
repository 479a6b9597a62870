#include "core/scene/scene_cache.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "core/base/machine.h"
#include "core/base/mutex.h"
#include "core/base/text.h"
#include "core/base/udim.h"
#include "core/geometry/read_hair.h"
#include "core/geometry/read_places.h"

namespace hyades::core {
namespace {

// Of the bounds of a grid's density, along the longest side.
constexpr int kVoxelsPerCell = 6;
constexpr int kMostCells = 128;

/// Files of frames, cut into their materials, that are kept: those of two frames, and some more.
constexpr size_t kRecentParts = 4;

bool same_placements(const std::vector<Placement>& a, const std::vector<Placement>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_placement);
}

}  // namespace

Result<std::shared_ptr<const MeshParts>> SceneCache::parts_of(const std::string& file,
                                                              bool of_frames) {
  const auto make = [&]() -> Result<std::shared_ptr<const MeshParts>> {
    auto loaded = read_mesh_parts(assets_, file);
    if (!loaded) return loaded.error();
    return std::make_shared<const MeshParts>(std::move(*loaded));
  };
  if (!of_frames) return mesh_parts_.get(file, make);
  auto parts = frame_parts_.get(file, make);
  if (!parts) return parts;
  const MutexLock lock(recent_parts_mutex_);
  if (std::find(recent_parts_.begin(), recent_parts_.end(), *parts) == recent_parts_.end()) {
    recent_parts_.push_back(*parts);
    if (recent_parts_.size() > kRecentParts) recent_parts_.pop_front();
  }
  return parts;
}

Result<std::shared_ptr<const TriangleMesh>> SceneCache::read(const std::string& file,
                                                             const MeshUse& use, bool of_frames) {
  std::shared_ptr<TriangleMesh> mesh;
  if (use.part.empty()) {
    auto loaded = read_mesh(assets_, file);
    if (!loaded) return loaded.error();
    mesh = *loaded;
  } else {
    const auto all = parts_of(file, of_frames);
    if (!all) return all.error();
    const std::vector<MeshPart>& parts = (*all)->parts;
    const auto part = std::find_if(parts.begin(), parts.end(),
                                   [&](const MeshPart& each) { return each.name == use.part; });
    if (part == parts.end()) {
      std::vector<std::string> names;
      for (const MeshPart& each : parts) names.push_back(each.name);
      const std::string hint = did_you_mean(use.part, names);
      return Error{file + ": it has no material '" + use.part + "'" +
                   (hint.empty() ? "; there is " + join_names(names) : hint)};
    }
    mesh = std::make_shared<TriangleMesh>(*part->mesh);
    mesh->name = file;
    finish_mesh(*mesh);  // a copy has no padding
  }
  if (use.normals == MeshNormals::flat) mesh->normals.clear();
  if (use.normals == MeshNormals::smooth) compute_smooth_normals(*mesh);
  if (!use.extras.colors) mesh->colors = {};
  if (!use.extras.second_uvs) mesh->second_uvs = {};
  const bool from_file = !mesh->vertex_tangents.empty() && use.normals == MeshNormals::file;
  if (!use.extras.tangents || !from_file) mesh->vertex_tangents = {};
  if (use.extras.tangents && !from_file) compute_tangents(*mesh);
  return std::shared_ptr<const TriangleMesh>(mesh);
}

Result<std::shared_ptr<const TriangleMesh>> SceneCache::mesh(const std::string& file,
                                                             const MeshUse& use) {
  return meshes_.get({file, use}, [&] { return read(file, use, false); });
}

Result<std::shared_ptr<const TriangleMesh>> SceneCache::frame_mesh(const std::string& file,
                                                                   const MeshUse& use) {
  return frame_meshes_.get({file, use}, [&] { return read(file, use, true); });
}

Result<std::shared_ptr<const std::vector<PlaceMatrix>>> SceneCache::places(
    const std::string& file) {
  return places_.get(file, [&] { return read_places(assets_, file, usable_memory()); });
}

Result<std::shared_ptr<const CurveSet>> SceneCache::curves(const std::string& file,
                                                           CurveBasis basis) {
  return curves_.get({file, basis},
                     [&] { return read_hair(assets_, file, basis, usable_memory()); });
}

Result<std::shared_ptr<const Image>> SceneCache::image(const std::string& file, ColorSpace space) {
  return images_.get({file, space}, [&]() -> Result<std::shared_ptr<const Image>> {
    auto bytes = assets_.open(file);
    if (!bytes) return bytes.error();
    auto loaded = read_image(*bytes, file, space);
    if (!loaded) return loaded.error();
    return std::make_shared<const Image>(std::move(*loaded));
  });
}

Result<PyramidPtr> SceneCache::pyramid(const std::string& file, const ImageUse& use) {
  return pyramids_.get({file, use}, [&]() -> Result<PyramidPtr> {
    auto bytes = assets_.open(file);
    if (!bytes) return bytes.error();
    auto loaded = read_image(*bytes, file, use.space);
    if (!loaded) return loaded.error();
    auto made = ImagePyramid::make(*loaded, use.wrap, *texels_);
    if (!made) return made.error().in(file);
    return made;
  });
}

Result<std::shared_ptr<const std::vector<int>>> SceneCache::udim(const std::string& pattern) {
  return udims_.get(pattern, [&]() -> Result<std::shared_ptr<const std::vector<int>>> {
    auto tiles = udim_tiles(assets_, pattern);
    if (!tiles) return tiles.error();
    return std::make_shared<const std::vector<int>>(std::move(*tiles));
  });
}

Result<std::shared_ptr<const EnvironmentMap>> SceneCache::environment_map(const std::string& file,
                                                                          SkyDensity density) {
  const auto key = std::pair(file, density);
  return environment_maps_.get(key, [&]() -> Result<std::shared_ptr<const EnvironmentMap>> {
    auto picture = image(file, ColorSpace::automatic);
    if (!picture) return picture.error();
    return std::make_shared<const EnvironmentMap>(*picture, density);
  });
}

Result<std::shared_ptr<const Gobo>> SceneCache::gobo(const std::string& file) {
  return gobos_.get(file, [&]() -> Result<std::shared_ptr<const Gobo>> {
    auto picture = image(file, ColorSpace::automatic);
    if (!picture) return picture.error();
    return std::make_shared<const Gobo>(*picture);
  });
}

std::shared_ptr<const Sky> SceneCache::sky(const SkySettings& settings) {
  const MutexLock lock(sky_mutex_);
  if (!sky_ || !(settings == sky_settings_)) {
    sky_settings_ = settings;
    sky_ = std::make_shared<const Sky>(make_sky(settings));
  }
  return sky_;
}

Result<std::shared_ptr<const VdbGrid<float>>> SceneCache::vdb_numbers(const VdbUse& use) {
  return vdb_numbers_.get(use, [&]() -> Result<std::shared_ptr<const VdbGrid<float>>> {
    auto bytes = assets_.open(use.file);
    if (!bytes) return bytes.error();
    auto read = read_vdb_numbers(*bytes, use.grid);
    if (!read) return read.error().in(use.file);
    return *read;
  });
}

Result<std::shared_ptr<const VdbGrid<Rgb>>> SceneCache::vdb_colors(const VdbUse& use) {
  return vdb_colors_.get(use, [&]() -> Result<std::shared_ptr<const VdbGrid<Rgb>>> {
    auto bytes = assets_.open(use.file);
    if (!bytes) return bytes.error();
    auto read = read_vdb_colors(*bytes, use.grid);
    if (!read) return read.error().in(use.file);
    return *read;
  });
}

Result<std::shared_ptr<const VdbDensity>> SceneCache::vdb_density(const VdbUse& use) {
  return vdb_densities_.get(use, [&]() -> Result<std::shared_ptr<const VdbDensity>> {
    auto numbers = vdb_numbers(use);
    if (!numbers) return numbers.error();
    const std::shared_ptr<const BrickGrid<float>> voxels(*numbers, &(*numbers)->voxels);
    VdbDensity density{*numbers, make_grid_density(voxels), nullptr};
    const Bounds bounds = voxels->bounds();
    const auto bricks = static_cast<int>(max_component(bounds.size())) / kVoxelsPerCell;
    density.majorants = std::make_shared<const MajorantGrid>(
        *density.field, MajorantGrid::cells_for(bounds, std::clamp(bricks, 1, kMostCells)));
    return std::make_shared<const VdbDensity>(std::move(density));
  });
}

std::shared_ptr<const TriangleMesh> SceneCache::made_mesh(
    const std::string& key, std::shared_ptr<TriangleMesh> (*make)(const Vec3&), const Vec3& size) {
  auto made = made_meshes_.get(key, [&]() -> Result<std::shared_ptr<const TriangleMesh>> {
    return std::shared_ptr<const TriangleMesh>(make(size));
  });
  return *made;
}

MeshClosure SceneCache::closure(const std::shared_ptr<const TriangleMesh>& mesh) {
  return **closures_.get(mesh, [&]() -> Result<std::shared_ptr<const MeshClosure>> {
    return std::make_shared<const MeshClosure>(examine_closure(*mesh));
  });
}

Result<std::shared_ptr<const World>> SceneCache::world(std::vector<Placement> placements,
                                                       RenderClass which) {
  const MutexLock lock(world_mutex_);
  if (world_ && world_class_ == which && same_placements(placements, world_placements_)) {
    return world_;
  }
  world_class_ = which;
  world_placements_ = placements;
  auto built = build_world(std::move(placements), geometry_, which);
  if (!built) {
    world_.reset();
    return built.error();
  }
  world_ = *built;
  return world_;
}

size_t SceneCache::image_memory() const {
  size_t bytes = 0;
  images_.for_each([&](const Image& image) { bytes += image.data.size() * sizeof(float); });
  pyramids_.for_each([&](const ImagePyramid& pyramid) { bytes += pyramid.memory(); });
  return bytes;
}

}  // namespace hyades::core
