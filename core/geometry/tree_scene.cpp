#include "core/geometry/tree_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <tuple>
#include <utility>

#include "core/base/fp_mode.h"
#include "core/geometry/chunks.h"
#include "core/geometry/instancer_scene.h"
#include "core/geometry/placed_world.h"
#include "core/geometry/triangle.h"
#include "core/geometry/watertight.h"

namespace hyades::core {
namespace {

constexpr uint32_t kNoVertex = std::numeric_limits<uint32_t>::max();

/// Directions and origins of one space: those of the world, of a copy or of an instance.
struct SpaceRay {
  Vec3d origin;
  Vec3d direction;
  SlabRay slabs;
  WatertightLine line;

  SpaceRay(const Vec3d& o, const Vec3d& d) : origin(o), direction(d), slabs(o, d), line(o, d) {}
  SpaceRay in(const Affine& to_local) const {
    return {to_local.point(origin), to_local.vector(direction)};
  }
};

/// `box` with room for what rounding may do to it on its way.
MovingBounds with_margin(MovingBounds box) {
  for (Bounds* b : {&box.begin, &box.end}) {
    const Vec3 margin = 0x1p-21F * glm::max(glm::abs(b->lower), glm::abs(b->upper));
    *b = {b->lower - margin, b->upper + margin};
  }
  return box;
}

/// A box that moves straight and holds, at equal steps over the shutter, what `box_at(step)` says,
/// and all that goes straight from each to the next.
template <class BoxAt>
MovingBounds bounds_over(size_t steps, const BoxAt& box_at) {
  MovingBounds all;
  all.begin = box_at(0);
  if (steps == 1) return {all.begin, all.begin};
  all.end = box_at(steps - 1);
  Vec3 below(0.0F);
  Vec3 above(0.0F);
  for (size_t step = 1; step + 1 < steps; ++step) {
    const Bounds between = all.at(static_cast<float>(step) / static_cast<float>(steps - 1));
    const Bounds box = box_at(step);
    below = glm::max(below, between.lower - box.lower);
    above = glm::max(above, box.upper - between.upper);
  }
  for (Bounds* b : {&all.begin, &all.end}) *b = {b->lower - below, b->upper + above};
  return all;
}

const TreeScene& tree_of(const RayScene& scene) { return static_cast<const TreeScene&>(scene); }

}  // namespace

/// The way of one ray through a scene and those in it.
class TreeWalk {
 public:
  TreeWalk(const Ray& ray, RayKind kind, float t_min)
      : ray_(ray),
        time_(std::clamp(ray.time, 0.0F, 1.0F)),
        mask_(static_cast<unsigned>(kind)),
        t_min_(t_min),
        limit_(ray.t_max) {}

  std::optional<SceneHit> nearest(const TreeScene& scene) {
    walk(scene, world(), {});
    if (best_.t == kNowhere) return std::nullopt;
    return best_;
  }

  bool any(const TreeScene& scene) {
    any_ = true;
    return walk(scene, world(), {});
  }

 private:
  static constexpr double kNowhere = std::numeric_limits<double>::infinity();
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

  /// What of the scenes the walk is in.
  struct Place {
    float enters = 0.0F;             ///< where the ray comes into the boxes of them all
    uint32_t scene = kNone;          ///< the number of a scene in the topmost
    uint32_t copy_number = 0;        ///< of the copy
    const CopyPose* copy = nullptr;  ///< where that stands; null: in none
    const TreeScene::Geometry* instance = nullptr;
  };

  SpaceRay world() const { return {Vec3d(ray_.origin), Vec3d(ray_.direction)}; }

  /// True ends the walk; so do those below.
  bool walk(const TreeScene& scene, const SpaceRay& local, const Place& place) {
    return scene.tree_.traverse(
        local.slabs, time_, t_min_, limit_, [&](uint32_t first, uint32_t count) {
          for (uint32_t i = first; i < first + count; ++i) {
            const TreeScene::Item item = scene.items_[i];
            const TreeScene::Geometry& geometry = scene.geometries_[item.geometry];
            if ((geometry.mask & mask_) == 0) continue;
            if (geometry.stands ? meet_standing(scene, i, local, place)
                                : meet(scene, geometry, item.primitive, local, place)) {
              return true;
            }
          }
          return false;
        });
  }

  bool meet_standing(const TreeScene& scene, uint32_t number, const SpaceRay& local,
                     const Place& place) {
    const std::array<Vec3, 3>& corners = scene.corners_[number];
    const std::array<Vec3d, 3> exact{Vec3d(corners[0]), Vec3d(corners[1]), Vec3d(corners[2])};
    const std::optional<double> t = meet_corners(exact, local);
    if (!t) return false;
    Bounds box;
    for (const Vec3& corner : corners) box.include(corner);
    const TreeScene::Item item = scene.items_[number];
    return take(scene.geometries_[item.geometry], item.primitive, *t, place,
                enter_box(local.slabs, scene.at_time({box, box}, time_), t_min_));
  }

  bool meet_moving(const TreeScene& scene, const TreeScene::Geometry& geometry, uint32_t primitive,
                   const SpaceRay& local, const Place& place) {
    const MeshBuffers& mesh = *geometry.mesh;
    const std::optional<double> t =
        meet_corners(mesh.moving_corners(mesh.indices[primitive], ray_.time), local);
    // Its box takes longer than the triangle.
    return t && take(geometry, primitive, *t, place,
                     enter_box(local.slabs, scene.bounds_at(geometry, primitive, time_), t_min_));
  }

  /// Where the ray meets a triangle, if that is of interest.
  std::optional<double> meet_corners(const std::array<Vec3d, 3>& corners,
                                     const SpaceRay& local) const {
    if (!local.line.meets(corners)) return std::nullopt;
    const auto met = meet_triangle(local.origin, local.direction, Triangle(corners));
    if (!met || !is_wanted(met->t)) return std::nullopt;
    return met->t;
  }

  bool meet(const TreeScene& scene, const TreeScene::Geometry& geometry, uint32_t primitive,
            const SpaceRay& local, const Place& place) {
    if (geometry.kind == TreeScene::Kind::mesh) {
      return meet_moving(scene, geometry, primitive, local, place);
    }
    const float enters =
        enter_box(local.slabs, scene.bounds_at(geometry, primitive, time_), t_min_);
    if (enters > limit_) return false;
    switch (geometry.kind) {
      case TreeScene::Kind::curves:
      case TreeScene::Kind::quadric: {
        const PlacedObject& object =
            place.instance != nullptr ? *place.instance->object : *geometry.object;
        const std::optional<Hit> hit = object.meet(ray_, primitive, place.copy);
        if (!hit || !is_wanted(static_cast<double>(hit->t))) return false;
        return take(geometry, primitive, static_cast<double>(hit->t), place, enters);
      }
      case TreeScene::Kind::instance: {
        Place inside = deeper(place, enters);
        inside.instance = &geometry;
        return walk(*geometry.scene, local.in(geometry.object->to_object_at(ray_.time)), inside);
      }
      case TreeScene::Kind::scene: {
        Place inside = deeper(place, enters);
        inside.scene = geometry.number;
        return walk(*geometry.scene, local, inside);
      }
      case TreeScene::Kind::copies: {
        const CopyPose pose = geometry.copies->pose(primitive, ray_.time);
        Place inside = deeper(place, enters);
        inside.copy = &pose;
        inside.copy_number = primitive;
        return walk(*geometry.scene, local.in(pose.to_copy), inside);
      }
      case TreeScene::Kind::mesh:
        break;
    }
    return false;
  }

  static Place deeper(const Place& place, float enters) {
    Place inside = place;
    inside.enters = std::max(inside.enters, enters);
    return inside;
  }

  bool is_wanted(double t) const {
    return t > static_cast<double>(t_min_) && t < static_cast<double>(ray_.t_max) && t <= best_.t;
  }

  /// Takes a surface at distance `t` that is in a box which the ray comes into at `enters`.
  bool take(const TreeScene::Geometry& geometry, uint32_t primitive, double t, const Place& place,
            float enters) {
    // What is met before its own boxes, by rounding, is met there: so it is met whatever other
    // boxes it is sought in.
    t = std::max(t, static_cast<double>(std::max(enters, place.enters)));
    if (!(t < static_cast<double>(ray_.t_max))) return false;
    if (any_) return true;
    const uint32_t object = (place.instance != nullptr ? *place.instance : geometry).number;
    SceneHit hit;
    hit.number = place.scene == kNone ? object : place.scene;
    hit.inner = object;
    hit.copied = object;
    hit.copy = place.copy_number;
    hit.primitive = primitive;
    hit.t = t;
    // Where two are equally far, the first of the world's placements.
    const Rank rank(place.copy != nullptr ? place.scene : object, place.copy_number, object,
                    primitive);
    if (t > best_.t || (t == best_.t && rank_ < rank)) return false;
    best_ = hit;
    rank_ = rank;
    limit_ = std::nextafter(static_cast<float>(t), kInfinity);
    return false;
  }

  using Rank = std::tuple<uint32_t, uint32_t, uint32_t, uint32_t>;

  const Ray& ray_;
  float time_;  ///< of the shutter, 0 to 1
  unsigned mask_;
  float t_min_;
  float limit_;  ///< no nearer than best_.t
  bool any_ = false;
  Rank rank_;
  SceneHit best_{.t = kNowhere};
};

uint32_t TreeScene::Geometry::size() const {
  switch (kind) {
    case Kind::mesh:
      return static_cast<uint32_t>(mesh->mesh().triangles.size());
    case Kind::curves:
      return static_cast<uint32_t>(curves->pieces.size());
    case Kind::copies:
      return copies->copy_count();
    default:
      return 1;
  }
}

bool TreeScene::Geometry::moves() const {
  switch (kind) {
    case Kind::mesh:
      return mesh->vertices_move();
    case Kind::curves:
      return false;
    case Kind::quadric:
    case Kind::instance:
      return !object->motion().still();
    case Kind::scene:
      return scene->moves();
    case Kind::copies:
      return !copies->motion().still() || scene->moves();
  }
  return false;
}

MovingBounds TreeScene::Geometry::bounds_of(uint32_t primitive) const {
  switch (kind) {
    case Kind::mesh: {
      const std::array<uint32_t, 3>& t = mesh->triangles[primitive];
      if (t[0] == kNoVertex) return {};
      return bounds_over(mesh->steps.size(), [&](size_t step) {
        Bounds b;
        for (const uint32_t corner : t) b.include(mesh->steps[step][corner]);
        return b;
      });
    }
    case Kind::curves:
      return bounds_over(1, [&](size_t) { return curves->bounds_of(primitive); });
    case Kind::quadric:
    case Kind::instance:
      return bounds_over(object->motion().steps().size(),
                         [&](size_t step) { return object->bounds_at_step(step); });
    case Kind::scene:
      return bounds_over(1, [&](size_t) { return scene->bounds(); });
    case Kind::copies:
      return bounds_over(copies->motion().steps().size(), [&](size_t step) {
        return copies->bounds_of_copy(primitive, step, scene->bounds());
      });
  }
  return {};
}

TreeScene::TreeScene(std::vector<Geometry> geometries) : geometries_(std::move(geometries)) {
  moves_ = std::any_of(geometries_.begin(), geometries_.end(),
                       [](const Geometry& g) { return g.moves(); });
  std::vector<Item> items;
  std::vector<MovingBounds> boxes;
  for (uint32_t g = 0; g < geometries_.size(); ++g) {
    const Geometry& geometry = geometries_[g];
    const size_t first = boxes.size();
    boxes.resize(first + geometry.size());
    items.resize(boxes.size());
    for_chunks(geometry.size(), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        items[first + i] = {g, static_cast<uint32_t>(i)};
        const MovingBounds bounds = geometry.bounds_of(static_cast<uint32_t>(i));
        boxes[first + i] = moves_ && !bounds.begin.empty() ? with_margin(bounds) : bounds;
      }
    });
  }
  size_t kept = 0;
  for (size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].begin.empty()) continue;
    boxes[kept] = boxes[i];
    items[kept++] = items[i];
  }
  boxes.resize(kept);
  if (moves_) {
    tree_.build(boxes);
  } else {
    std::vector<Bounds> still(kept);
    for (size_t i = 0; i < kept; ++i) still[i] = boxes[i].begin;
    tree_.build(still);
  }
  items_.resize(kept);
  const bool any_stands = std::any_of(geometries_.begin(), geometries_.end(),
                                      [](const Geometry& g) { return g.stands; });
  if (any_stands) corners_.resize(kept);
  for_chunks(kept, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      items_[i] = items[tree_.order()[i]];
      const Geometry& geometry = geometries_[items_[i].geometry];
      if (!geometry.stands) continue;
      const std::array<uint32_t, 3>& t = geometry.mesh->indices[items_[i].primitive];
      for (size_t k = 0; k < 3; ++k) corners_[i][k] = geometry.mesh->steps[0][t[k]];
    }
  });
  tree_.forget_order();
}

Bounds TreeScene::at_time(const MovingBounds& bounds, float time) const {
  return moves_ ? with_margin(bounds).at(time) : bounds.begin;
}

std::optional<SceneHit> TreeScene::nearest(const Ray& ray, RayKind kind, float t_min) const {
  return TreeWalk(ray, kind, t_min).nearest(*this);
}

bool TreeScene::occluded(const Ray& ray) const {
  return TreeWalk(ray, RayKind::occlusion, kNearest).any(*this);
}

size_t TreeScene::memory() const {
  return geometries_.capacity() * sizeof(Geometry) + items_.capacity() * sizeof(Item) +
         corners_.capacity() * sizeof(corners_[0]) + tree_.memory();
}

TreeScene::Geometry& TreeBuilder::add(TreeScene::Kind kind, unsigned mask, uint32_t number) {
  TreeScene::Geometry& geometry = geometries_.emplace_back();
  geometry.kind = kind;
  geometry.mask = mask;
  geometry.number = number;
  return geometry;
}

void TreeBuilder::add_mesh(const MeshBuffers& buffers, unsigned mask, uint32_t number) {
  TreeScene::Geometry& geometry = add(TreeScene::Kind::mesh, mask, number);
  geometry.stands = !buffers.vertices_move();
  geometry.mesh = &buffers;
}

void TreeBuilder::add_curves(const CurveSet& curves, unsigned mask, uint32_t number) {
  add(TreeScene::Kind::curves, mask, number).curves = &curves;
}

void TreeBuilder::add_quadric(const PlacedObject& object, unsigned mask, uint32_t number) {
  add(TreeScene::Kind::quadric, mask, number).object = &object;
}

void TreeBuilder::add_instance(const RayScene& scene, const PlacedObject& object, unsigned mask,
                               uint32_t number) {
  TreeScene::Geometry& geometry = add(TreeScene::Kind::instance, mask, number);
  geometry.object = &object;
  geometry.scene = &tree_of(scene);
}

void TreeBuilder::add_scene(const RayScene& scene, uint32_t number) {
  add(TreeScene::Kind::scene, kAllRays, number).scene = &tree_of(scene);
}

void TreeBuilder::add_copies(const InstancerScene& copies) {
  TreeScene::Geometry& geometry = add(TreeScene::Kind::copies, kAllRays, 0);
  geometry.scene = &tree_of(copies.inner().scene());
  geometry.copies = &copies;
}

Result<std::shared_ptr<const RayScene>> TreeBuilder::commit() {
  try {
    const FpMode mode;
    return std::shared_ptr<const RayScene>(
        std::make_shared<const TreeScene>(std::move(geometries_)));
  } catch (const std::bad_alloc&) {
    return Error{"no memory for the hierarchy of the scene"};
  }
}

}  // namespace hyades::core
