#include "core/integrators/visibility.h"

#include "core/scene/media_around.h"

namespace hyades::core {

void keep_blockers(const Scene& scene, uint8_t blockers, MediumStack& around) {
  around.keep([&](const Body& body) { return is_blocker(scene.objects[body.object], blockers); });
  if (!is_in(scene.rest_in_lists, blockers)) around.keep_no_atmosphere();
}

void cross(const SceneObject& object, const SurfacePoint& point, const Vec3& direction,
           MediumStack& around) {
  if (object.body == nullptr) return;
  if (glm::dot(direction, point.ng) < 0.0F) {
    around.enter(*object.body);
  } else {
    around.leave(*object.body);
  }
}

namespace {

/// Follows `ray` to its end, through null surfaces and what is there of others. 0 where one stands
/// in the way. What is not among the `blockers` is not there, nor what is in it.
Rgb share_through_shells(const Scene& scene, const Ray& ray, RayKind kind,
                         const MediumStack& around, MediaNumbers numbers, Workspace& work,
                         uint8_t blockers = 0) {
  Rgb share(1.0F);
  const auto pass = [&](const Medium* medium, const Ray& way, float t_max) {
    if (medium != nullptr) share *= medium->transmittance(way, t_max, numbers.next());
  };
  MediumStack inside = around;
  if (blockers != 0) keep_blockers(scene, blockers, inside);
  Ray way = ray;
  SurfacePoint point;
  for (int crossings = 0; crossings < kMaxNullCrossings; ++crossings) {
    ++work.rays;
    if (!scene.world->nearest(way, kind, point)) {
      pass(inside.medium(), way, way.t_max);
      return share;
    }
    const SceneObject& object = scene.objects[point.object];
    const bool is_there = is_blocker(object, blockers);
    const bool passes = !is_there || is_unseen(object, point, way.direction, kind);
    const float straight = passes ? 1.0F : straight_share(object, point, inside);
    if (!(straight > 0.0F)) return Rgb(0.0F);
    share *= straight;
    pass(inside.medium(), way, point.t);
    if (is_black(share)) return share;
    if (is_there) cross(object, point, way.direction, inside);
    const float left = way.t_max - point.t;
    way = spawn_ray(point, way.direction);
    way.t_max = left;
    if (!(left > 0.0F)) return share;
  }
  return Rgb(0.0F);
}

/// visible_share where `around` are bodies that shadow rays see.
Rgb visible_share_within(const Scene& scene, const Ray& shadow, const MediumStack& around,
                         MediaNumbers numbers, Workspace& work, uint8_t blockers) {
  if (blockers != 0)
    return share_through_shells(scene, shadow, RayKind::shadow, around, numbers, work, blockers);
  ++work.rays;
  if (scene.world->occluded(shadow)) return Rgb(0.0F);
  // What blocks light for certain was asked for; other surfaces on the way are shells, or hidden.
  if (scene.has_shells)
    return share_through_shells(scene, shadow, RayKind::shadow, around, numbers, work);
  const Medium* medium = around.medium();
  return medium != nullptr ? medium->transmittance(shadow, shadow.t_max, numbers.next())
                           : Rgb(1.0F);
}

}  // namespace

Ray shadow_ray(const SurfacePoint& from, const LightSample& to) {
  return to.distance == kInfinity ? spawn_ray(from, to.direction)
                                  : spawn_ray_to(from, to.position, 0.0F);
}

Ray shadow_ray(const Vec3& from, const LightSample& to, float time) {
  return to.distance == kInfinity ? Ray{from, to.direction, kInfinity, time}
                                  : ray_between(from, to.position, time);
}

Rgb visible_share(const Scene& scene, const Ray& shadow, const MediumStack& around,
                  MediaNumbers numbers, Workspace& work, uint8_t blockers) {
  if (scene.hides_bodies) {
    MediumStack seen = around;
    keep_seen(scene, RayKind::shadow, seen);
    return visible_share_within(scene, shadow, seen, numbers, work, blockers);
  }
  return visible_share_within(scene, shadow, around, numbers, work, blockers);
}

Rgb visible_share_from_camera(const Scene& scene, const Ray& ray, MediaNumbers numbers,
                              Workspace& work) {
  return share_through_shells(scene, ray, RayKind::camera, bodies_around_lens(scene, ray), numbers,
                              work);
}

}  // namespace hyades::core
