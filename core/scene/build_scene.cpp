#include "core/scene/build_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/film/id_counts.h"
#include "core/geometry/placement_check.h"
#include "core/job/check_colors.h"
#include "core/job/check_frame.h"
#include "core/job/darkness.h"
#include "core/job/frame_files.h"
#include "core/job/layers.h"
#include "core/scene/add_bodies.h"
#include "core/scene/appearance.h"
#include "core/scene/camera_makers.h"
#include "core/scene/environment_makers.h"
#include "core/scene/exteriors.h"
#include "core/scene/flatten.h"
#include "core/scene/light_linking.h"
#include "core/scene/light_makers.h"
#include "core/scene/media_around.h"
#include "core/scene/scene_files.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

/// How far the world reaches from the middle of its bounds: infinite lights weigh their power by
/// it.
float world_radius(const World& world) {
  const Bounds bounds = world.bounds();
  return bounds.empty() ? 1.0F : 0.5F * std::sqrt(glm::dot(bounds.size(), bounds.size()));
}

class SceneBuilder {
 public:
  SceneBuilder(const Job& job, int32_t frame, SceneCache& cache)
      : job_(job),
        frame_(frame),
        time_(job.time_of(frame)),
        cache_(cache),
        looks_(job, time_, cache) {}

  Result<std::shared_ptr<const Scene>> build() {
    const auto held = load_files(job_, frame_, cache_);
    if (!held) return held.error();
    if (auto done = add_objects(); !done) return done.error();
    if (auto done = add_lights(); !done) return done.error();
    if (auto done = add_environment(); !done) return done.error();
    link_objects();
    warn_of_darkness();
    for (std::string& doubt : doubtful_light_colors(job_)) {
      scene_->warnings.push_back(std::move(doubt));
    }
    if (auto done = add_camera(); !done) return done.error();
    if (auto done = add_motion(); !done) return done.error();
    add_media_around_camera();
    scene_->selector = make_tree_selector(scene_->lights, receivers());
    scene_->resolution = {job_.film.width, job_.film.height};
    scene_->window = render_window(job_.film);
    scene_->texture_memory = cache_.image_memory();
    return std::shared_ptr<const Scene>(std::move(scene_));
  }

 private:
  Status add_objects() {
    auto flat = flatten_objects(job_, frame_, cache_);
    if (!flat) return flat.error();
    if (auto done = add_atmosphere(*flat); !done) return done;
    std::vector<Placement> placements;
    placements.reserve(flat->size());
    const std::set<std::string> front_only = materials_seen_from_the_front();
    add_notices(*flat);
    for (const FlatObject& object : *flat) {
      auto material = looks_.surface(object.material, object.desc->interior);
      if (!material) return at_object(object, material.error());
      const std::string& look = object.material.empty() ? kDefaultMaterial : object.material;
      scene_->objects.push_back({.material = *material,
                                 .front_only = front_only.contains(look),
                                 .holdout = object.holdout,
                                 .name = object.name,
                                 .material_name = look,
                                 .ids = {id_of(object.name), id_of(look)}});
      placements.push_back(object.placement);
      const bool cutout = (*material)->is_cutout();
      placements.back().blocks_light = !(*material)->is_null() && !cutout;
      scene_->has_shells |= cutout;
      if (object.placement.shape.mesh) {
        const auto& instancer = object.placement.instancer;
        scene_->triangles += object.placement.shape.mesh->triangles.size() *
                             (instancer == nullptr ? 1 : instancer->places->size());
      }
    }
    if (auto done = add_bodies(job_, *flat, looks_, *scene_, placements); !done) return done;
    scene_->medium_groups = looks_.medium_groups();
    warn_of_open_bodies(*flat, cache_, *scene_);
    lists_.emplace(*scene_);
    for (const Placement& placement : placements) note_rays(placement.seen_by);
    if (auto done = add_lamps(placements); !done) return done;
    auto world = cache_.world(std::move(placements), job_.render.render_class);
    if (!world) return blame(*flat, world.error());
    scene_->world = *world;
    if (auto done = check_exteriors(job_, *flat, *scene_); !done) return done;
    return add_emitters(*flat);
  }

  /// The balls of lights that have a size, after all objects: what only rays meet that were
  /// scattered.
  Status add_lamps(std::vector<Placement>& placements) {
    const LightSetting setting{time_, job_.units};
    for (const LightDesc& desc : job_.lights) {
      auto lamp = make_lamp(desc, setting, cache_);
      if (!lamp) return Error{Diagnostic{desc.where, lamp.error().message}.to_string()};
      if (!*lamp) continue;
      lamps_.emplace(&desc, PlacedLamp{(*lamp)->source, static_cast<uint32_t>(placements.size())});
      scene_->objects.push_back({.material = make_null(),
                                 .name = desc.name,
                                 .material_name = kDefaultMaterial,
                                 .ids = {id_of(desc.name), id_of(kDefaultMaterial)}});
      Placement ball;
      ball.shape.kind = Shape::Kind::sphere;
      ball.shape.radius = (*lamp)->radius;
      ball.to_world[0][3] = Vec4((*lamp)->source->position(), 1.0F);
      ball.seen_by = (kinds_of(desc.visible) & RayKind::scattered) | RayKind::shadow;
      ball.blocks_light = false;
      ball.changes_between_frames = (*lamp)->changes_between_frames;
      placements.push_back(std::move(ball));
    }
    return {};
  }

  std::set<std::string> materials_seen_from_the_front() const {
    std::set<std::string> names;
    for (const MaterialDesc& material : job_.materials) {
      if (material.sides == "front") names.insert(material.name);
    }
    return names;
  }

  /// What instances of one object have in common is told once.
  void add_notices(const std::vector<FlatObject>& objects) {
    std::set<std::pair<const ObjectDesc*, std::string>> told;
    for (const FlatObject& object : objects) {
      if (object.notice.empty() || !told.insert({object.desc, object.notice}).second) continue;
      scene_->warnings.push_back("object '" + object.name + "': " + object.notice);
    }
  }

  Status add_atmosphere(const std::vector<FlatObject>& objects) {
    auto atmosphere = looks_.medium(job_.atmosphere);
    if (!atmosphere) return atmosphere.error().in("atmosphere");
    scene_->atmosphere = *atmosphere;
    scene_->has_media = *atmosphere != nullptr ||
                        std::any_of(objects.begin(), objects.end(), [&](const FlatObject& object) {
                          return !object.desc->interior.empty() || !object.desc->exterior.empty() ||
                                 looks_.has_subsurface(object.material);
                        });
    return {};
  }

  /// At the middle of the lens when the shutter opens: a camera that goes through a surface in
  /// mid-frame is taken to be on the side where it began.
  void add_media_around_camera() {
    const Vec3 eye = job_.camera.look_from.at(time_) * job_.units;
    scene_->around_camera = media_around(*scene_, eye, 0.0F);
  }

  /// The error of a world, which knows objects only by number, in the job's words; all objects that
  /// cannot be placed are told.
  Error blame(const std::vector<FlatObject>& objects, const Error& error) const {
    Diagnostics diagnostics;
    for (const FlatObject& object : objects) {
      if (const Status good = check_placement(object.placement); !good) {
        diagnostics.add(object.desc->where,
                        good.error().in("object '" + object.name + "'").message);
      }
    }
    if (!diagnostics.empty()) return diagnostics.to_error();
    return job_.file.empty() ? error : error.in(job_.file);
  }

  /// The lights of all shapes that emit, in the order of the objects.
  Status add_emitters(const std::vector<FlatObject>& flat) {
    const auto varying = std::count_if(flat.begin(), flat.end(), [&](const FlatObject& object) {
      const size_t i = static_cast<size_t>(&object - flat.data());
      return object.emit &&
             (!object.emit->color.texture.empty() || scene_->objects[i].material->is_cutout());
    });
    // So that a thousand textured lamps do not take a thousand times as long as one.
    constexpr int64_t kLookUps = int64_t{1} << 21;
    const auto look_ups =
        static_cast<uint32_t>(std::min(kLookUps / std::max<int64_t>(varying, 1), int64_t{1} << 18));
    for (uint32_t first = 0; first < flat.size();) {
      uint32_t end = first + 1;  // of the parts of one shape
      while (end < flat.size() && flat[end].body == flat[first].body) ++end;
      std::vector<uint32_t> parts(end - first);
      std::iota(parts.begin(), parts.end(), first);
      if (flat[first].emit) {
        if (auto done = add_emitter(flat[first], parts, look_ups); !done) return done;
      }
      first = end;
    }
    return {};
  }

  Status add_emitter(const FlatObject& object, const std::vector<uint32_t>& parts,
                     uint32_t look_ups) {
    const EmitDesc& emit = *object.emit;
    auto color = looks_.color(emit.color);
    if (!color) return at_object(object, color.error());
    const MaterialPtr& material = scene_->objects[parts[0]].material;
    SurfaceEmission emission;
    emission.radiance = color->texture ? Rgb(1.0F) : color->value;
    emission.two_sided = emit.two_sided;
    emission.texture = color->texture;
    emission.cutout = material->is_cutout() ? material : nullptr;
    emission.profile = make_spread(emit.spread.at(time_) * kRadians);
    emission.look_ups = look_ups;
    const float amount = emit.amount.at(time_);
    std::optional<float> power;
    if (emit.unit == EmitDesc::Unit::power) {
      power = amount * luminance(emission.radiance);
    } else {
      emission.radiance *= amount;
    }
    auto link = link_of(emit.links, object.placement.seen_by);
    if (!link) return link.error();
    const std::vector<LightPtr> lights = make_area_lights(*scene_->world, parts, emission, power);
    for (size_t i = 0; i < parts.size(); ++i) {
      scene_->objects[parts[i]].light =
          add_light(lights[i], scene_->objects[parts[i]].name, emit.light_group, *link);
    }
    return {};
  }

  /// How a light is linked whose surface, or whose light, is seen by rays of `seen_by`.
  Result<LightLink> link_of(const LightLinkDesc& desc, RayKind seen_by) {
    const auto receivers = lists_->number_of(desc.light_linking);
    if (!receivers) return receivers.error();
    const auto blockers = lists_->number_of(desc.shadow_linking);
    if (!blockers) return blockers.error();
    scene_->tells_rays_apart |= (seen_by & RayKind::scattered) != RayKind::scattered;
    scene_->shadows_differ |= *blockers != 0;
    return LightLink{seen_by, *receivers, *blockers};
  }

  /// Notes whether rays must be told apart for a surface that is seen by `seen_by`.
  void note_rays(RayKind seen_by) {
    const RayKind scattered = seen_by & RayKind::scattered;
    scene_->tells_rays_apart |= scattered != RayKind::scattered;
    const RayKind as_shadow = meet(seen_by, RayKind::shadow) ? RayKind::scattered : RayKind::none;
    scene_->shadows_differ |= scattered != as_shadow;
  }

  /// Once all lights are there: the lists that each object is in.
  void link_objects() {
    for (size_t i = 0; i < scene_->objects.size(); ++i) {
      SceneObject& object = scene_->objects[i];
      object.in_lists = i < lists_->objects() ? lists_->of(i) : lists_->of_rest();
    }
    scene_->rest_in_lists = lists_->of_rest();
    for (size_t i = 0; i < scene_->lights.size(); ++i) {
      if (scene_->lights[i]->is_delta()) continue;
      scene_->blocker_lists |= ListBits{1} << scene_->light_links[i].blockers;
    }
  }

  std::vector<uint8_t> receivers() const {
    std::vector<uint8_t> receivers;
    for (const LightLink& link : scene_->light_links) receivers.push_back(link.receivers);
    return receivers;
  }

  uint32_t add_light(LightPtr light, const std::string& name, const std::string& group,
                     const LightLink& link) {
    const auto index = static_cast<uint32_t>(scene_->lights.size());
    if (light->is_infinite()) scene_->infinite_lights.push_back(index);
    scene_->lights.push_back(std::move(light));
    scene_->light_names.push_back(name);
    scene_->light_groups.push_back(group);
    scene_->light_links.push_back(link);
    return index;
  }

  Status add_lights() {
    const LightSetting setting = this->setting();
    for (const LightDesc& desc : job_.lights) {
      const auto link = link_of(desc.links, kinds_of(desc.visible));
      if (!link) return link.error();
      if (const auto lamp = lamps_.find(&desc); lamp != lamps_.end()) {
        const auto& [source, object] = lamp->second;
        scene_->objects[object].light = add_light(make_ball_light(*scene_->world, object, source),
                                                  desc.name, desc.light_group, *link);
        continue;
      }
      auto light = make_light(desc, setting, cache_);
      if (!light) return Error{Diagnostic{desc.where, light.error().message}.to_string()};
      add_light(*light, desc.name, desc.light_group, *link);
    }
    return {};
  }

  /// The environment, after all other lights; nothing where there is none.
  Status add_environment() {
    if (!job_.environment) return {};
    const EnvironmentDesc& sky = *job_.environment;
    auto lights = make_environment(sky, setting(), cache_);
    if (!lights) return Error{Diagnostic{sky.where, lights.error().message}.to_string()};
    const auto link = link_of(sky.links, kinds_of(sky.visible));
    if (!link) return link.error();
    for (auto& [name, light] : *lights) add_light(std::move(light), name, sky.light_group, *link);
    scene_->environment_visible = sky.visible.camera;
    return {};
  }

  /// An even sky has no power of its own (Light::power()), but is as bright everywhere.
  static bool shines(const LightPtr& light) {
    if (light->power() > 0.0F) return true;
    const auto is_bright = [&](const Vec3& from) {
      return max_component(light->radiance(SurfacePoint(), -from)) > 0.0F;
    };
    return light->is_infinite() &&
           (is_bright({0, 1, 0}) || is_bright({0, -1, 0}) || is_bright({1, 0, 0}) ||
            is_bright({0, 0, 1}) || is_bright({-1, 0, 0}) || is_bright({0, 0, -1}));
  }

  void warn_of_darkness() {
    if (any_medium_glows(job_)) return;
    if (!scene_->lights.empty()) {
      // Animations may well begin in the dark.
      const bool still = job_.frames.first == job_.frames.last;
      if (!still || std::any_of(scene_->lights.begin(), scene_->lights.end(), shines)) return;
      scene_->warnings.emplace_back(
          "its lights give nothing, the picture will be black: expected one that is brighter "
          "than 0");
      return;
    }
    scene_->warnings.emplace_back(kNothingGivesLight);
  }

  Status add_camera() {
    auto camera = make_camera(job_, frame_, [&](const std::string& object, float shutter_time) {
      return center_of(object, shutter_time);
    });
    if (!camera) return camera.error();
    scene_->camera = std::move(*camera);
    looks_.view()->set(scene_->camera);
    return {};
  }

  Status add_motion() {
    if (!needed_layers(job_).motion) return {};
    auto next = flatten_objects(job_, frame_ + 1, cache_, Displacements::left_out);
    if (!next) return next.error();
    auto motion = std::make_unique<FilmMotion>();
    motion->camera = make_sharp_camera(job_, time_);
    motion->next_camera = make_sharp_camera(job_, job_.time_of(frame_ + 1));
    for (uint32_t i = 0; i < next->size(); ++i) {
      const Placement& then = (*next)[i].placement;
      motion->to_world.push_back(then.instancer == nullptr ? then.to_world.front()
                                                           : then.instancer->to_world.front());
      const auto& mesh = scene_->world->placement(i).shape.mesh;
      const bool deforms = then.instancer == nullptr && then.shape.mesh != mesh &&
                           then.shape.mesh != nullptr && is_file_sequence((*next)[i].desc->mesh) &&
                           same_topology(*mesh, *then.shape.mesh);
      motion->meshes.push_back(deforms ? then.shape.mesh : nullptr);
    }
    scene_->motion = std::move(motion);
    return {};
  }

  LightSetting setting() const {
    return {time_, job_.units, world_radius(*scene_->world), sky_density(job_.integrator)};
  }

  /// The middle of the bounds of object `name` (groups: of all within).
  Vec3 center_of(const std::string& name, float shutter_time) const {
    Bounds bounds;
    for (uint32_t i = 0; i < scene_->objects.size(); ++i) {
      const std::string& path = scene_->objects[i].name;
      if (path != name && !path.starts_with(name + "/")) continue;
      const Placement& placement = scene_->world->placement(i);
      bounds.include(placement.instancer != nullptr
                         ? scene_->world->bounds_of(i)
                         : transformed(scene_->world->transform_at(i, shutter_time),
                                       bounds_of(placement.shape)));
    }
    return bounds.empty() ? Vec3(0.0F) : bounds.center();
  }

  const Job& job_;
  int32_t frame_;
  JobTime time_;
  SceneCache& cache_;
  Appearance looks_;
  struct PlacedLamp {
    PointSourcePtr source;
    uint32_t object;  ///< index of its ball's placement
  };
  std::map<const LightDesc*, PlacedLamp> lamps_;
  std::optional<LinkingLists> lists_;
  std::unique_ptr<Scene> scene_ = std::make_unique<Scene>();
};

}  // namespace

Result<std::shared_ptr<const Scene>> build_scene(const Job& job, int32_t frame, SceneCache& cache) {
  if (auto kept = check_frame(job, frame); !kept) return kept.error();
  return SceneBuilder(job, frame, cache).build();
}

}  // namespace hyades::core
