#include "core/scene/add_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include <fmt/format.h>

#include "core/geometry/affine.h"
#include "core/job/layers.h"
#include "core/scene/rank_bodies.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

/// Over the shutter interval.
Bounds bounds_in_world(const Placement& placement) {
  const Bounds local = bounds_of(placement.shape);
  Bounds bounds;
  for (const Mat4& m : placement.to_world) bounds.include(transformed(m, local));
  if (placement.instancer == nullptr) return bounds;
  Bounds all;
  for (const Mat4& m : placement.instancer->to_world) {
    for (const PlaceMatrix& place : *placement.instancer->places) {
      all.include(transformed(m * place_matrix(place), bounds));
    }
  }
  return all;
}

/// Of what the surface (of an instancer: its first copy) encloses when the shutter opens. The same
/// however it is turned, and less than that of a body around it.
double volume_of(const Placement& placement, SceneCache& cache) {
  const Shape& shape = placement.shape;
  double scale = std::abs(Affine(placement.to_world[0]).determinant());
  if (placement.instancer != nullptr) {
    const Mat4 place = place_matrix(placement.instancer->places->front());
    scale *= std::abs(Affine(placement.instancer->to_world[0] * place).determinant());
  }
  const double r = shape.radius;
  switch (shape.kind) {
    case Shape::Kind::sphere:
      return scale * double{kPi} * r * r * r * 4.0 / 3.0;
    case Shape::Kind::cylinder:
      return scale * double{kPi} * r * r * double{shape.height};
    case Shape::Kind::mesh:
      return scale * std::abs(cache.closure(shape.mesh).volume);
    case Shape::Kind::disk:
    case Shape::Kind::curves:
      break;
  }
  return 0.0;
}

class BodyMaker {
 public:
  BodyMaker(const Job& job, const std::vector<FlatObject>& objects, Appearance& looks, Scene& scene)
      : job_(job), objects_(objects), looks_(looks), scene_(scene) {}

  Status add_all() {
    if (auto done = check_priorities(); !done) return done;
    if (auto done = check_glass(); !done) return done;
    if (!light_asks_for_bodies()) return {};
    for (size_t i = 0; i < objects_.size(); ++i) {
      // Further parts of a surface share what is inside.
      if (objects_[i].body != i) {
        scene_.objects[i].body = scene_.objects[objects_[i].body].body;
      } else if (auto done = add(objects_[i], scene_.objects[i]); !done) {
        return done;
      }
    }
    return {};
  }

  /// Puts the bodies in order.
  void rank(std::vector<Placement>& placements) {
    const std::vector<uint32_t> ranks = rank_bodies(extents_);
    const std::vector<bool> hidden = may_be_hidden(extents_, ranks);
    for (size_t i = 0; i < ranks.size(); ++i) {
      scene_.bodies[i].rank = ranks[i];
      scene_.bodies[i].may_be_hidden = hidden[i];
    }
    for (size_t i = 0; i < placements.size(); ++i) {
      const Body* body = scene_.objects[i].body;
      if (body == nullptr) continue;
      if (body->may_be_hidden) placements[i].blocks_light = false;
      scene_.has_shells |= !placements[i].blocks_light;
    }
  }

 private:
  Status check_priorities() const {
    for (size_t i = 0; i < objects_.size(); ++i) {
      const FlatObject& object = objects_[i];
      if (object.desc->priority == 0 || !object.desc->interior.empty() ||
          scene_.objects[i].material->leads_inside()) {
        continue;
      }
      return at_object(object, Error{"it has a priority, but light does not go into it; expected a "
                                     "material such as dielectric, or an interior"});
    }
    return {};
  }

  /// Whether light goes into it through its surface, as into glass.
  static bool is_entered(const FlatObject& object, const SceneObject& seen) {
    return has_inside(*object.desc) && seen.material->leads_inside();
  }

  /// Rays that went in are of a kind that must see the surface from within.
  Status check_glass() const {
    for (size_t i = 0; i < objects_.size(); ++i) {
      const FlatObject& object = objects_[i];
      if (meet(object.placement.seen_by, RayKind::transmission)) continue;
      if (!is_entered(object, scene_.objects[i])) continue;
      return at_object(object, Error{"light goes into it and must come out again; expected "
                                     "visible_to_transmission: true"});
    }
    return {};
  }

  /// Without media it matters only what else a surface refracts against.
  bool light_asks_for_bodies() const {
    if (scene_.has_media) return true;
    const auto refracting =
        std::count_if(scene_.objects.begin(), scene_.objects.end(),
                      [](const SceneObject& object) { return object.material->index() > 0.0F; });
    return refracting > 1;
  }

  /// What fills a body is there for all rays but the camera's. `filled`: with a medium.
  Status check_visible(const FlatObject& object, bool filled) {
    const RayKind seen_by = object.placement.seen_by;
    scene_.hides_bodies |= (seen_by | RayKind::camera) != RayKind::all;
    if (filled && !meet(seen_by, RayKind::camera) && makes_splats(job_.integrator)) {
      return at_object(
          object, Error{"it is not visible to the camera but has an interior, which light paths "
                        "would show; expected visible_to_camera: true, or integrator: path"});
    }
    if (filled && (seen_by | RayKind::camera) != RayKind::all) {
      return at_object(object,
                       Error{"it has an interior or a subsurface, which all rays but the camera's "
                             "must see; expected visible_to_diffuse, _glossy, _transmission, "
                             "_volume and _shadow: true"});
    }
    return {};
  }

  /// In scenes with media even an empty glass matters, for it keeps the atmosphere out.
  Status add(const FlatObject& object, SceneObject& added) {
    auto interior = interior_of(object);
    if (!interior) return at_object(object, interior.error());
    const bool entered = is_entered(object, added);
    if (*interior == nullptr && !entered) return {};
    if (auto done = check_visible(object, *interior != nullptr); !done) return done;
    Body& body = scene_.bodies.emplace_back();
    body.object = static_cast<uint32_t>(&added - scene_.objects.data());
    body.medium = *interior;
    body.filled_with = object.desc->interior;
    body.index = entered ? added.material->index() : 0.0F;
    body.open = added.material->is_null();
    added.body = &body;
    extents_.push_back({object.desc->priority, body.refracts(),
                        volume_of(object.placement, looks_.cache()),
                        bounds_in_world(object.placement)});
    return {};
  }

  Result<MediumPtr> interior_of(const FlatObject& object) {
    if (!object.desc->interior.empty() || !looks_.has_subsurface(object.material)) {
      return looks_.medium_in(object.desc->interior, object.placement);
    }
    if (!has_inside(*object.desc)) {
      return Error{"material '" + object.material +
                   "' has a subsurface, for which it needs an inside: a mesh, a sphere, a box or a "
                   "cylinder with caps"};
    }
    return looks_.subsurface(object.material);
  }

  const Job& job_;
  const std::vector<FlatObject>& objects_;
  Appearance& looks_;
  Scene& scene_;
  std::vector<BodyExtent> extents_;  ///< of Scene::bodies
};

}  // namespace

Status add_bodies(const Job& job, const std::vector<FlatObject>& objects, Appearance& looks,
                  Scene& scene, std::vector<Placement>& placements) {
  BodyMaker maker(job, objects, looks, scene);
  if (auto done = maker.add_all(); !done) return done;
  maker.rank(placements);
  return {};
}

void warn_of_open_bodies(const std::vector<FlatObject>& objects, SceneCache& cache, Scene& scene) {
  std::set<const TriangleMesh*> told;
  for (size_t i = 0; i < objects.size(); ++i) {
    const FlatObject& object = objects[i];
    const auto& mesh = object.placement.shape.mesh;
    const Material& material = *scene.objects[i].material;
    const bool refracts = material.leads_inside() && material.index() > 0.0F;
    if (scene.objects[i].body == nullptr && !refracts) continue;
    if (!mesh || !has_inside(*object.desc) || !told.insert(mesh.get()).second) continue;
    const MeshClosure closure = cache.closure(mesh);
    std::string wrong;
    if (closure.open_edges > 0) {
      wrong = fmt::format(
          "is open: {} of its edges are not shared by triangles that face the same way; what light "
          "that goes through a hole meets is left to chance",
          closure.open_edges);
    } else if (closure.inside_out()) {
      wrong =
          "is inside out: its normals point inwards, and so light takes what is around it for its "
          "inside";
    }
    if (!wrong.empty())
      scene.warnings.push_back(
          at_object(object, Error{"the mesh '" + mesh->name + "' " + wrong}).message);
  }
}

}  // namespace hyades::core
