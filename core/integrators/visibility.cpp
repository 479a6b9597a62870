#include "core/integrators/visibility.h"

namespace hyades::core {

void cross(const SceneObject& object, const SurfacePoint& point, const Vec3& direction,
           MediumStack& around) {
  if (object.body == SceneObject::kNoBody) return;
  if (glm::dot(direction, point.ng) < 0.0F) {
    around.enter(object.body, object.interior.get());
  } else {
    around.leave(object.body);
  }
}

Rgb visible_share(const Scene& scene, const Ray& shadow, const MediumStack& around,
                  MediaNumbers numbers, Workspace& work) {
  ++work.rays;
  if (scene.world->occluded(shadow)) return Rgb(0.0F);
  Rgb share(1.0F);
  if (!scene.has_media) return share;
  const auto pass = [&](const Medium* medium, const Ray& way, float t_max) {
    if (medium != nullptr) share *= medium->transmittance(way, t_max, numbers.next());
  };
  if (!scene.has_shells) {
    pass(around.medium(), shadow, shadow.t_max);
    return share;
  }
  // Nothing on the way blocks light, so every surface there is a shell.
  MediumStack inside = around;
  Ray way = shadow;
  SurfacePoint point;
  for (int crossings = 0; crossings < kMaxNullCrossings; ++crossings) {
    ++work.rays;
    if (!scene.world->nearest(way, RayKind::other, point)) {
      pass(inside.medium(), way, way.t_max);
      return share;
    }
    pass(inside.medium(), way, point.t);
    if (is_black(share)) return share;
    cross(scene.objects[point.object], point, way.direction, inside);
    const float left = way.t_max - point.t;
    way = spawn_ray(point, way.direction);
    way.time = shadow.time;
    way.t_max = left;
    if (!(left > 0.0F)) return share;
  }
  return Rgb(0.0F);
}

}  // namespace hyades::core
