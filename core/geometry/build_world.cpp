#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/base/fp_mode.h"
#include "core/geometry/build_thresholds.h"
#include "core/geometry/embree_geometry.h"
#include "core/geometry/embree_world.h"

namespace hyades::core {
namespace {

/// Coordinates beyond this leave no room for Embree's products of three lengths in a float.
constexpr float kLargestCoordinate = 1e12F;

/// Embree's limit for matrices of one motion (RTC_MAX_TIME_STEP_COUNT).
constexpr size_t kMaxSteps = 129;

constexpr unsigned kAllRays = 0xFFFFFFFFU;

unsigned mask_of(const Placement& p) {
  auto mask = static_cast<unsigned>(RayKind::other);
  if (p.visible_to_camera) mask |= static_cast<unsigned>(RayKind::camera);
  if (p.blocks_light) mask |= static_cast<unsigned>(RayKind::shadow);
  return mask;
}

size_t triangle_count(const Placement& p) {
  return p.shape.kind == Shape::Kind::mesh ? p.shape.mesh->triangles.size() : 1;
}

bool all_finite(const Mat4& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r])) return false;
    }
  }
  return true;
}

std::string describe(const Placement& p, size_t number) {
  std::string text = "object " + std::to_string(number);
  if (p.shape.kind == Shape::Kind::mesh && p.shape.mesh != nullptr)
    text += " (" + p.shape.mesh->name + ")";
  return text;
}

Status check_shape(const Shape& shape) {
  if (shape.kind == Shape::Kind::mesh) {
    if (shape.mesh == nullptr) return Error{"it has no mesh"};
    return {};
  }
  if (!(shape.radius > 0.0F) || !std::isfinite(shape.radius)) {
    return Error{"its radius must be positive and finite"};
  }
  if (shape.kind == Shape::Kind::cylinder &&
      (!(shape.height > 0.0F) || !std::isfinite(shape.height))) {
    return Error{"its height must be positive and finite"};
  }
  return {};
}

/// Whether the inverse of `m` exists well enough to compute with.
bool invertible(const Affine& m) {
  double product = 1.0;
  for (int i = 0; i < 3; ++i) product *= std::sqrt(glm::dot(m.linear[i], m.linear[i]));
  // The determinant of the columns made unit vectors: 0 where they lie in one plane.
  return product > 0.0 && std::abs(m.determinant()) > 1e-12 * product;
}

Status check_motion(const std::vector<Mat4>& matrices) {
  if (matrices.empty()) return Error{"it has no transform"};
  if (matrices.size() > kMaxSteps) {
    return Error{"it has " + std::to_string(matrices.size()) + " motion steps; at most " +
                 std::to_string(kMaxSteps) + " are possible"};
  }
  for (const Mat4& m : matrices) {
    if (!all_finite(m)) return Error{"its transform is not finite"};
  }
  const Motion motion(matrices);
  const bool mirrored = motion.steps()[0].determinant() < 0.0;
  for (const Affine& step : motion.steps()) {
    if (!invertible(step)) return Error{"its transform is singular: it flattens the shape"};
    if ((step.determinant() < 0.0) != mirrored) {
      return Error{"its transform turns the shape inside out while the shutter is open"};
    }
  }
  return {};
}

Status check_placement(const Placement& p) {
  if (Status s = check_shape(p.shape); !s) return s;
  if (Status s = check_motion(p.to_world); !s) return s;
  const Bounds box = bounds_of(p.shape);
  if (box.empty()) return {};
  for (const Mat4& m : p.to_world) {
    const Bounds b = transform_bounds(Affine(m), box);
    const float largest =
        std::max(max_component(glm::abs(b.lower)), max_component(glm::abs(b.upper)));
    if (!(largest <= kLargestCoordinate)) return Error{"it reaches beyond a distance of 1e12"};
  }
  return {};
}

/// How a placement gets into the world.
enum class Way {
  direct,    ///< in world space, in the top scene
  shared,    ///< in world space, in the still scene that frames share
  instance,  ///< its mesh has a scene of its own
};

/// Depends on the placements alone: never on what was built before.
std::vector<Way> choose_ways(const std::vector<Placement>& placements,
                             const BuildThresholds& thresholds) {
  std::map<const TriangleMesh*, size_t> uses;
  for (const Placement& p : placements) {
    if (p.shape.kind == Shape::Kind::mesh) ++uses[p.shape.mesh.get()];
  }
  std::vector<Way> ways;
  size_t still_triangles = 0;
  bool any_changes = false;
  for (const Placement& p : placements) {
    const bool mesh = p.shape.kind == Shape::Kind::mesh;
    const size_t copies = mesh ? uses[p.shape.mesh.get()] : 1;
    const bool repeated = copies > 1 && copies * triangle_count(p) > thresholds.copied_triangles;
    const bool moves = p.to_world.size() > 1;
    const bool rebuilt_often =
        p.changes_between_frames && triangle_count(p) > thresholds.shared_triangles;
    any_changes = any_changes || p.changes_between_frames;
    if (mesh && (repeated || moves || rebuilt_often)) {
      ways.push_back(Way::instance);
    } else if (moves || p.changes_between_frames) {
      ways.push_back(Way::direct);
    } else {
      ways.push_back(Way::shared);
      still_triangles += triangle_count(p);
    }
  }
  if (!any_changes || still_triangles <= thresholds.shared_triangles) {
    std::replace(ways.begin(), ways.end(), Way::shared, Way::direct);
  }
  return ways;
}

bool same(const Placement& a, const Placement& b) {
  return a.shape.kind == b.shape.kind && a.shape.mesh == b.shape.mesh &&
         a.shape.radius == b.shape.radius && a.shape.height == b.shape.height &&
         a.to_world == b.to_world && a.visible_to_camera == b.visible_to_camera &&
         a.blocks_light == b.blocks_light;
}

/// Makes the object of a placement in world space.
std::shared_ptr<const PlacedObject> make_direct(Placement p) {
  std::shared_ptr<const MeshBuffers> buffers;
  const bool mesh = p.shape.kind == Shape::Kind::mesh;
  if (mesh) {
    const Affine to_world(p.to_world[0]);
    buffers = make_mesh_buffers(p.shape.mesh, &to_world);
  }
  return std::make_shared<const PlacedObject>(std::move(p), std::move(buffers), mesh);
}

void attach_direct(SceneBuilder& builder, const PlacedObject& object, uint32_t number) {
  const unsigned mask = mask_of(object.placement());
  builder.attach(object.is_quadric() ? new_quadric_geometry(builder.device(), object, mask)
                                     : new_mesh_geometry(builder.device(), *object.buffers(), mask),
                 number);
}

/// Builds worlds with the help of one cache, whose lock it holds.
class WorldBuilder {
 public:
  explicit WorldBuilder(GeometryCache::State& cache) : cache_(cache), lock_(cache.mutex) {}

  Result<std::shared_ptr<const World>> build(std::vector<Placement> placements,
                                             const BuildThresholds& thresholds) {
    const std::vector<Way> ways = choose_ways(placements, thresholds);
    if (Status s = add_shared(placements, ways); !s) return s.error();
    parts_.objects.resize(placements.size());
    if (parts_.still != nullptr) {
      for (const NumberedObject& o : parts_.still->objects) parts_.objects[o.number] = o.object;
    }
    std::vector<std::shared_ptr<const MeshScene>> instanced(placements.size());
    for (size_t i = 0; i < placements.size(); ++i) {
      if (ways[i] == Way::direct) parts_.objects[i] = make_direct(std::move(placements[i]));
      if (ways[i] != Way::instance) continue;
      auto mesh = mesh_scene(placements[i].shape.mesh);
      if (!mesh) return mesh.error();
      instanced[i] = *mesh;
      parts_.objects[i] =
          std::make_shared<const PlacedObject>(std::move(placements[i]), (*mesh)->buffers, false);
    }
    if (Status s = build_top(ways, instanced); !s) return s.error();
    remember();
    return std::shared_ptr<const World>(std::make_shared<EmbreeWorld>(std::move(parts_)));
  }

 private:
  /// Finds the still scene of the frame before or makes one.
  Status add_shared(const std::vector<Placement>& placements, const std::vector<Way>& ways) {
    std::vector<uint32_t> numbers;
    for (size_t i = 0; i < ways.size(); ++i) {
      if (ways[i] == Way::shared) numbers.push_back(static_cast<uint32_t>(i));
    }
    if (numbers.empty()) return {};
    parts_.still = cache_.still.lock();
    if (parts_.still != nullptr && is_made_of(*parts_.still, placements, numbers)) return {};
    auto fresh = std::make_shared<StillScene>();
    for (const uint32_t i : numbers) fresh->objects.push_back({i, make_direct(placements[i])});
    SceneBuilder builder;
    for (const NumberedObject& o : fresh->objects) attach_direct(builder, *o.object, o.number);
    auto scene = builder.commit();
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
                        return o.number == i && same(o.object->placement(), placements[i]);
                      });
  }

  Result<std::shared_ptr<const MeshScene>> mesh_scene(
      const std::shared_ptr<const TriangleMesh>& mesh) {
    std::weak_ptr<const MeshScene>& known = cache_.meshes[mesh.get()];
    if (auto found = known.lock()) {
      if (used_.insert(found.get()).second) parts_.mesh_scenes.push_back(found);
      return found;
    }
    auto fresh = std::make_shared<MeshScene>();
    fresh->buffers = make_mesh_buffers(mesh, nullptr);
    SceneBuilder builder;
    builder.attach(new_mesh_geometry(builder.device(), *fresh->buffers, kAllRays), 0);
    auto scene = builder.commit();
    if (!scene) return scene.error();
    fresh->scene = *scene;
    known = fresh;
    used_.insert(fresh.get());
    parts_.mesh_scenes.push_back(fresh);
    return std::shared_ptr<const MeshScene>(std::move(fresh));
  }

  Status build_top(const std::vector<Way>& ways,
                   const std::vector<std::shared_ptr<const MeshScene>>& instanced) {
    SceneBuilder builder;
    for (size_t i = 0; i < ways.size(); ++i) {
      const PlacedObject& object = *parts_.objects[i];
      const auto number = static_cast<uint32_t>(i);
      if (ways[i] == Way::direct) attach_direct(builder, object, number);
      if (ways[i] == Way::instance) {
        builder.attach(new_instance_geometry(builder.device(), instanced[i]->scene->handle(),
                                             object.motion(), mask_of(object.placement())),
                       number);
      }
    }
    if (parts_.still != nullptr) {
      builder.attach(new_instance_geometry(builder.device(), parts_.still->scene->handle(),
                                           Motion(), kAllRays),
                     static_cast<uint32_t>(ways.size()));
    }
    auto top = builder.commit();
    if (!top) return top.error();
    parts_.top = *top;
    return {};
  }

  /// Keeps what this world uses until the next is built, and forgets the rest.
  void remember() {
    std::vector<std::shared_ptr<const void>> recent(parts_.mesh_scenes.begin(),
                                                    parts_.mesh_scenes.end());
    if (parts_.still != nullptr) recent.push_back(parts_.still);
    cache_.recent = std::move(recent);
    std::erase_if(cache_.meshes, [](const auto& entry) { return entry.second.expired(); });
  }

  GeometryCache::State& cache_;
  std::lock_guard<std::mutex> lock_;
  WorldParts parts_;
  std::set<const MeshScene*> used_;  ///< those in parts_.mesh_scenes
};

}  // namespace

GeometryCache::GeometryCache() : state_(std::make_unique<State>()) {}
GeometryCache::~GeometryCache() = default;

Result<std::shared_ptr<const World>> build_world(std::vector<Placement> placements,
                                                 GeometryCache& cache) {
  return build_world(std::move(placements), cache, BuildThresholds());
}

Result<std::shared_ptr<const World>> build_world(std::vector<Placement> placements,
                                                 GeometryCache& cache,
                                                 const BuildThresholds& thresholds) {
  if (const auto device = embree_device(); !device) return device.error();
  for (size_t i = 0; i < placements.size(); ++i) {
    if (Status s = check_placement(placements[i]); !s) {
      return s.error().in(describe(placements[i], i));
    }
  }
  const FpMode mode;
  return WorldBuilder(cache.state()).build(std::move(placements), thresholds);
}

}  // namespace hyades::core
