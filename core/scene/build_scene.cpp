#include "core/scene/build_scene.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/elementary.h"
#include "core/geometry/placement_check.h"
#include "core/job/check_frame.h"
#include "core/job/kinds.h"
#include "core/scene/add_bodies.h"
#include "core/scene/appearance.h"
#include "core/scene/exteriors.h"
#include "core/scene/flatten.h"
#include "core/scene/light_makers.h"
#include "core/scene/media_around.h"
#include "core/scene/scene_files.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

constexpr float kRadians = kPi / 180.0F;
constexpr const char* kSky = "environment";
constexpr float kSensorHeight =
    0.024F;  // m, the short side of a 35 mm frame: what f-stops refer to

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
    if (auto done = load_files(job_, cache_); !done) return done.error();
    if (auto done = add_objects(); !done) return done.error();
    if (auto done = add_lights(); !done) return done.error();
    if (auto done = add_environment(); !done) return done.error();
    if (auto done = add_camera(); !done) return done.error();
    add_media_around_camera();
    scene_->selector = make_power_selector(scene_->lights);
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
    for (const FlatObject& object : *flat) {
      auto material = looks_.surface(object.material, object.desc->interior);
      if (!material) return at_object(object, material.error());
      scene_->objects.push_back({.material = *material, .name = object.name});
      placements.push_back(object.placement);
      placements.back().blocks_light = !(*material)->is_null();
      if (object.placement.shape.mesh)
        scene_->triangles += object.placement.shape.mesh->triangles.size();
    }
    if (auto done = add_bodies(job_, *flat, looks_, *scene_, placements); !done) return done;
    warn_of_open_bodies(*flat, cache_, *scene_);
    auto world = cache_.world(std::move(placements));
    if (!world) return blame(*flat, world.error());
    scene_->world = *world;
    if (auto done = check_exteriors(job_, *flat, *scene_); !done) return done;
    for (uint32_t i = 0; i < flat->size(); ++i) {
      if ((*flat)[i].emit) scene_->objects[i].light = add_emitter(i, *(*flat)[i].emit);
    }
    return {};
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

  uint32_t add_emitter(uint32_t object, const EmitDesc& emit) {
    Rgb radiance = emit.color.at(time_) * emit.amount.at(time_);
    if (emit.unit == EmitDesc::Unit::power) {
      const double area = surface_area(*scene_->world, object) * (emit.two_sided ? 2.0 : 1.0);
      radiance = area > 0.0 ? radiance * static_cast<float>(1.0 / (double{kPi} * area)) : Rgb(0.0F);
    }
    return add_light(make_area_light(*scene_->world, object, radiance, emit.two_sided),
                     scene_->objects[object].name);
  }

  uint32_t add_light(LightPtr light, const std::string& name) {
    const auto index = static_cast<uint32_t>(scene_->lights.size());
    if (light->is_infinite()) scene_->infinite_lights.push_back(index);
    scene_->lights.push_back(std::move(light));
    scene_->light_names.push_back(name);
    return index;
  }

  Status add_lights() {
    const LightSetting setting{time_, job_.units, world_radius(*scene_->world)};
    for (const LightDesc& desc : job_.lights) {
      auto light = make_light(desc, setting);
      if (!light) return Error{Diagnostic{desc.where, light.error().message}.to_string()};
      add_light(*light, desc.name);
    }
    return {};
  }

  Status add_environment() {
    if (!job_.environment) return {};
    const EnvironmentDesc& sky = *job_.environment;
    const Rgb scale = sky.color.at(time_) * sky.strength.at(time_);
    const float radius = world_radius(*scene_->world);
    if (sky.image.empty()) {
      add_light(make_environment_light(nullptr, 0.0F, scale, radius), kSky);
    } else {
      auto map = cache_.environment_map(sky.image);
      if (!map) {
        const Error error = map.error().in("environment");
        return Error{Diagnostic{sky.where, error.message}.to_string()};
      }
      const float turn = sky.rotate_y.at(time_) * kRadians;
      add_light(make_environment_map_light(*map, turn, scale, radius), kSky);
    }
    scene_->environment_visible = sky.visible_to_camera;
    return {};
  }

  Status add_camera() {
    const bool moves = job_.frames.shutter > 0.0F;
    const int steps = moves ? kShutterMoments - 1 : 0;
    std::vector<CameraPose> poses;
    for (int i = 0; i <= steps; ++i) {
      const float shutter_time = moves ? static_cast<float>(i) / static_cast<float>(steps) : 0.0F;
      auto pose = pose_at(shutter_time);
      if (!pose) return pose.error();
      poses.push_back(*pose);
    }
    scene_->camera = make_perspective_camera(std::move(poses), {job_.film.width, job_.film.height},
                                             job_.camera.aperture_blades,
                                             job_.camera.aperture_rotation * kRadians);
    return {};
  }

  Result<CameraPose> pose_at(float shutter_time) const {
    const CameraDesc& camera = job_.camera;
    const JobTime time = job_.time_of(frame_, shutter_time);
    CameraPose pose;
    pose.from = camera.look_from.at(time) * job_.units;
    pose.at = camera.look_at.at(time) * job_.units;
    pose.up = camera.up.at(time);
    pose.fov = camera.fov.at(time) * kRadians;
    const Vec3 axis = unit(pose.at - pose.from, {0.0F, 0.0F, -1.0F});
    if (!camera.focus_object.empty()) {
      pose.focus_distance =
          glm::dot(center_of(camera.focus_object, shutter_time) - pose.from, axis);
      if (!(pose.focus_distance > 0.0F)) return focus_behind(time, pose.focus_distance);
    } else if (camera.focus_distance) {
      pose.focus_distance = camera.focus_distance->at(time) * job_.units;
    } else {
      pose.focus_distance = glm::dot(pose.at - pose.from, axis);
    }
    pose.focus_distance = std::max(pose.focus_distance, 1e-6F * job_.units);
    if (camera.f_stop) {
      const float focal_length = 0.5F * kSensorHeight / tan(0.5F * pose.fov);
      pose.lens_radius = focal_length / (2.0F * camera.f_stop->at(time));
    } else {
      pose.lens_radius = camera.aperture_radius.at(time) * job_.units;
    }
    return pose;
  }

  Error focus_behind(const JobTime& time, float distance) const {
    const std::string message = fmt::format(
        "focus is on the object '{}', whose centre lies {:.4g} m behind the camera at frame "
        "{:.10g}, "
        "expected one in front of it",
        job_.camera.focus_object, -distance, time.frame);
    return {Diagnostic{job_.camera.focus_where, message}.to_string()};
  }

  /// The middle of the bounds of object `name` (groups: of all within).
  Vec3 center_of(const std::string& name, float shutter_time) const {
    Bounds bounds;
    for (uint32_t i = 0; i < scene_->objects.size(); ++i) {
      const std::string& path = scene_->objects[i].name;
      if (path != name && !path.starts_with(name + "/")) continue;
      bounds.include(transformed(scene_->world->transform_at(i, shutter_time),
                                 bounds_of(scene_->world->placement(i).shape)));
    }
    return bounds.empty() ? Vec3(0.0F) : bounds.center();
  }

  static Vec3 unit(const Vec3& v, const Vec3& fallback) {
    const float length = std::sqrt(glm::dot(v, v));
    return length > 0.0F ? v / length : fallback;
  }

  const Job& job_;
  int32_t frame_;
  JobTime time_;
  SceneCache& cache_;
  Appearance looks_;
  std::unique_ptr<Scene> scene_ = std::make_unique<Scene>();
};

}  // namespace

Result<std::shared_ptr<const Scene>> build_scene(const Job& job, int32_t frame, SceneCache& cache) {
  if (auto kept = check_frame(job, frame); !kept) return kept.error();
  return SceneBuilder(job, frame, cache).build();
}

}  // namespace hyades::core
