#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/fp_mode.h"
#include "core/base/mutex.h"
#include "core/geometry/build_thresholds.h"
#include "core/geometry/embree.h"
#include "core/geometry/geometry_cache.h"
#include "core/geometry/placed_world.h"
#include "core/geometry/placement_check.h"
#include "core/geometry/ray_scene.h"

namespace hyades::core {
namespace {

unsigned mask_of(const Placement& p) {
  const bool occludes = p.blocks_light && meet(p.seen_by, RayKind::shadow);
  return static_cast<unsigned>(occludes ? p.seen_by | RayKind::occlusion : p.seen_by);
}

size_t triangle_count(const Placement& p) {
  if (p.shape.kind == Shape::Kind::curves) return p.shape.curves->pieces.size();
  return p.shape.kind == Shape::Kind::mesh ? p.shape.mesh->triangles.size() : 1;
}

/// How a placement gets into the world.
enum class Placing {
  copied,    ///< as a member of an instancer, by its copies
  direct,    ///< in world space, in the top scene; vertices may move
  shared,    ///< in world space, in the still scene that frames share
  instance,  ///< its mesh, or its strands, have a scene of their own
};

/// Depends on the placements alone: never on what was built before. `inside_instancer`: they are
/// what an instancer copies.
std::vector<Placing> choose_placings(const std::vector<Placement>& placements,
                                     const BuildThresholds& thresholds, bool inside_instancer) {
  std::map<MeshKey, size_t> uses;
  for (const Placement& p : placements) {
    if (p.shape.kind == Shape::Kind::mesh && (inside_instancer || p.instancer == nullptr)) {
      ++uses[mesh_key(p.shape)];
    }
  }
  std::vector<Placing> placings;
  size_t still_triangles = 0;
  bool any_changes = false;
  for (const Placement& p : placements) {
    if (p.instancer != nullptr && !inside_instancer) {
      placings.push_back(Placing::copied);
      continue;
    }
    any_changes = any_changes || p.changes_between_frames;
    if (p.shape.kind == Shape::Kind::curves) {
      placings.push_back(Placing::instance);
      continue;
    }
    const bool mesh = p.shape.kind == Shape::Kind::mesh;
    const size_t copies = mesh ? uses[mesh_key(p.shape)] : 1;
    const bool repeated = copies > 1 && copies * triangle_count(p) > thresholds.copied_triangles;
    const bool moves = p.to_world.size() > 1;
    const bool deforms = mesh && p.shape.deforms();
    // What deforms is another mesh in the next frame: nothing of it can be shared.
    const bool rebuilt_often =
        p.changes_between_frames && !deforms && triangle_count(p) > thresholds.shared_triangles;
    if (mesh && (repeated || moves || rebuilt_often) && can_be_instanced(p)) {
      placings.push_back(Placing::instance);
    } else if (moves || deforms || p.changes_between_frames) {
      placings.push_back(Placing::direct);
    } else {
      placings.push_back(Placing::shared);
      still_triangles += triangle_count(p);
    }
  }
  if (!any_changes || still_triangles <= thresholds.shared_triangles) {
    std::replace(placings.begin(), placings.end(), Placing::shared, Placing::direct);
  }
  return placings;
}

/// Makes the object of a placement in world space.
std::shared_ptr<const PlacedObject> make_direct(Placement p) {
  std::shared_ptr<const MeshBuffers> buffers;
  if (p.shape.kind == Shape::Kind::mesh) {
    const Motion motion(p.to_world);
    buffers = make_mesh_buffers(p.shape, &motion);
  }
  return std::make_shared<const PlacedObject>(std::move(p), std::move(buffers));
}

void attach_direct(SceneBuilder& builder, const PlacedObject& object, uint32_t number) {
  const unsigned mask = mask_of(object.placement());
  if (object.is_quadric()) return builder.add_quadric(object, mask, number);
  builder.add_mesh(*object.buffers(), mask, number);
}

/// Builds worlds with the help of one cache, whose lock somebody holds.
class WorldBuilder {
 public:
  WorldBuilder(MadeGeometry& cache, RenderClass which) : cache_(cache), which_(which) {}

  Result<std::shared_ptr<const World>> build(std::vector<Placement> placements,
                                             const BuildThresholds& thresholds) {
    auto world = build_parts(std::move(placements), thresholds);
    if (!world) return world.error();
    remember();
    return std::shared_ptr<const World>(std::make_shared<PlacedWorld>(std::move(parts_)));
  }

 private:
  Status build_parts(std::vector<Placement> placements, const BuildThresholds& thresholds) {
    const std::vector<Placing> placings =
        choose_placings(placements, thresholds, inside_instancer_);
    if (Status s = add_shared(placements, placings); !s) return s.error();
    parts_.objects.resize(placements.size());
    if (parts_.still != nullptr) {
      for (const NumberedObject& o : parts_.still->objects) parts_.objects[o.number] = o.object;
    }
    if (!inside_instancer_) {
      if (Status s = add_instancers(placements); !s) return s.error();
    }
    std::vector<std::shared_ptr<const MeshScene>> instanced(placements.size());
    for (size_t i = 0; i < placements.size(); ++i) {
      if (placings[i] == Placing::direct) parts_.objects[i] = make_direct(std::move(placements[i]));
      if (placings[i] != Placing::instance) continue;
      auto mesh = mesh_scene(placements[i].shape);
      if (!mesh) return mesh.error();
      instanced[i] = *mesh;
      parts_.objects[i] =
          std::make_shared<const PlacedObject>(std::move(placements[i]), (*mesh)->buffers);
    }
    return build_top(placings, instanced);
  }

  /// Each run of placements with the same instancer.
  Status add_instancers(const std::vector<Placement>& placements) {
    for (size_t first = 0; first < placements.size();) {
      const std::shared_ptr<const PointInstancer>& instancer = placements[first].instancer;
      size_t end = first + 1;
      while (end < placements.size() && placements[end].instancer == instancer) ++end;
      if (instancer != nullptr) {
        const auto from = placements.begin();
        auto scene = instancer_scene(
            instancer, {from + static_cast<ptrdiff_t>(first), from + static_cast<ptrdiff_t>(end)});
        if (!scene) return scene.error();
        for (size_t i = first; i < end; ++i) {
          parts_.objects[i] = (*scene)->inner().objects()[i - first];
        }
        parts_.instancers.push_back({static_cast<uint32_t>(first), *scene});
      }
      first = end;
    }
    return {};
  }

  /// The copies of `members`; those of the frame before where they are the same.
  Result<std::shared_ptr<const InstancerScene>> instancer_scene(
      const std::shared_ptr<const PointInstancer>& instancer,
      const std::vector<Placement>& members) {
    for (const auto& known : cache_.instancers) {
      auto found = known.lock();
      if (found != nullptr && found->is_of(*instancer, members)) return found;
    }
    // A world of what is copied. Nothing in it is an instance that need not be: a ray that comes
    // near a copy would be transformed once more.
    const BuildThresholds all_direct{std::numeric_limits<size_t>::max(),
                                     std::numeric_limits<size_t>::max()};
    WorldBuilder builder(cache_, which_);
    builder.inside_instancer_ = true;
    if (Status s = builder.build_parts(members, all_direct); !s) return s.error();
    const auto inner = std::make_shared<const PlacedWorld>(std::move(builder.parts_));
    auto scene = std::make_shared<InstancerScene>(instancer, members, inner);
    if (Status s = scene->build(*make_scene_builder(which_)); !s) return s.error();
    cache_.instancers.push_back(scene);
    return std::shared_ptr<const InstancerScene>(std::move(scene));
  }

  /// Finds the still scene of the frame before or makes one.
  Status add_shared(const std::vector<Placement>& placements,
                    const std::vector<Placing>& placings) {
    std::vector<uint32_t> numbers;
    for (size_t i = 0; i < placings.size(); ++i) {
      if (placings[i] == Placing::shared) numbers.push_back(static_cast<uint32_t>(i));
    }
    if (numbers.empty()) return {};
    parts_.still = cache_.still.lock();
    if (parts_.still != nullptr && is_made_of(*parts_.still, placements, numbers)) return {};
    auto fresh = std::make_shared<StillScene>();
    for (const uint32_t i : numbers) fresh->objects.push_back({i, make_direct(placements[i])});
    const auto builder = make_scene_builder(which_);
    for (const NumberedObject& o : fresh->objects) attach_direct(*builder, *o.object, o.number);
    auto scene = builder->commit();
    if (!scene) return scene.error();
    fresh->scene = *scene;
    cache_.still = fresh;
    parts_.still = std::move(fresh);
    return {};
  }

  static bool is_made_of(const StillScene& still, const std::vector<Placement>& placements,
                         const std::vector<uint32_t>& numbers) {
    return std::equal(still.objects.begin(), still.objects.end(), numbers.begin(), numbers.end(),
                      [&](const NumberedObject& o, uint32_t i) {
                        return o.number == i &&
                               same_placement(o.object->placement(), placements[i]);
                      });
  }

  Result<std::shared_ptr<const MeshScene>> mesh_scene(const Shape& mesh) {
    std::weak_ptr<const MeshScene>& known = cache_.meshes[mesh_key(mesh)];
    if (auto found = known.lock()) {
      if (used_.insert(found.get()).second) parts_.mesh_scenes.push_back(found);
      return found;
    }
    auto fresh = std::make_shared<MeshScene>();
    const auto builder = make_scene_builder(which_);
    if (mesh.kind == Shape::Kind::curves) {
      fresh->curves = mesh.curves;
      builder->add_curves(*fresh->curves, kAllRays, 0);
    } else {
      fresh->buffers = make_mesh_buffers(mesh, nullptr);
      builder->add_mesh(*fresh->buffers, kAllRays, 0);
    }
    auto scene = builder->commit();
    if (!scene) return scene.error();
    fresh->scene = *scene;
    known = fresh;
    used_.insert(fresh.get());
    parts_.mesh_scenes.push_back(fresh);
    return std::shared_ptr<const MeshScene>(std::move(fresh));
  }

  Status build_top(const std::vector<Placing>& placings,
                   const std::vector<std::shared_ptr<const MeshScene>>& instanced) {
    const auto builder = make_scene_builder(which_);
    for (size_t i = 0; i < placings.size(); ++i) {
      const PlacedObject& object = *parts_.objects[i];
      const auto number = static_cast<uint32_t>(i);
      if (placings[i] == Placing::direct) attach_direct(*builder, object, number);
      if (placings[i] == Placing::instance) {
        builder->add_instance(*instanced[i]->scene, object, mask_of(object.placement()), number);
      }
    }
    if (parts_.still != nullptr) {
      builder->add_scene(*parts_.still->scene, static_cast<uint32_t>(placings.size()));
    }
    for (size_t i = 0; i < parts_.instancers.size(); ++i) {
      builder->add_scene(parts_.instancers[i].scene->scene(),
                         static_cast<uint32_t>(placings.size() + 1 + i));
    }
    auto top = builder->commit();
    if (!top) return top.error();
    parts_.top = *top;
    return {};
  }

  /// Keeps what this world uses until the next is built, and forgets the rest.
  void remember() {
    std::vector<std::shared_ptr<const void>> recent(parts_.mesh_scenes.begin(),
                                                    parts_.mesh_scenes.end());
    if (parts_.still != nullptr) recent.push_back(parts_.still);
    for (const PlacedInstancer& instancer : parts_.instancers) recent.push_back(instancer.scene);
    cache_.recent = std::move(recent);
    std::erase_if(cache_.instancers, [](const auto& instancer) { return instancer.expired(); });
    std::erase_if(cache_.meshes, [](const auto& entry) { return entry.second.expired(); });
  }

  MadeGeometry& cache_;
  RenderClass which_;
  bool inside_instancer_ = false;  ///< what is built is what an instancer copies
  WorldParts parts_;
  std::set<const MeshScene*> used_;  ///< those in parts_.mesh_scenes
};

}  // namespace

bool same_placement(const Placement& a, const Placement& b) {
  return a.shape.kind == b.shape.kind && mesh_key(a.shape) == mesh_key(b.shape) &&
         a.shape.radius == b.shape.radius && a.shape.height == b.shape.height &&
         a.to_world == b.to_world && a.seen_by == b.seen_by && a.blocks_light == b.blocks_light &&
         (a.instancer == nullptr) == (b.instancer == nullptr) &&
         (a.instancer == nullptr || (a.instancer->places == b.instancer->places &&
                                     a.instancer->to_world == b.instancer->to_world));
}

GeometryCache::GeometryCache() : state_(std::make_unique<State>()) {}
GeometryCache::~GeometryCache() = default;

Result<std::shared_ptr<const World>> build_world(std::vector<Placement> placements,
                                                 GeometryCache& cache, RenderClass which) {
  return build_world(std::move(placements), cache, which, BuildThresholds());
}

Result<std::shared_ptr<const World>> build_world(std::vector<Placement> placements,
                                                 GeometryCache& cache, RenderClass which,
                                                 const BuildThresholds& thresholds) {
  if (which == RenderClass::native) {
    if (const auto device = embree_device(); !device) return device.error();
  }
  for (size_t i = 0; i < placements.size(); ++i) {
    if (Status s = check_placement(placements[i]); !s) {
      return s.error().in(describe_placement(placements[i], i));
    }
  }
  const FpMode mode;
  GeometryCache::State& state = cache.state();
  const MutexLock lock(state.mutex);
  MadeGeometry& made = which == RenderClass::native ? state.native : state.portable;
  return WorldBuilder(made, which).build(std::move(placements), thresholds);
}

}  // namespace hyades::core
