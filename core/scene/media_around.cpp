#include "core/scene/media_around.h"

#include <algorithm>
#include <vector>

namespace hyades::core {
namespace {

constexpr int kMostSurfaces = 100'000;

/// Any direction would do; one that no wall of a room is parallel to.
const Vec3 kDirection = glm::normalize(Vec3(0.3117F, 0.8312F, 0.4604F));

}  // namespace

MediumStack media_around(const Scene& scene, const Vec3& point, float time) {
  MediumStack stack(scene.atmosphere.get());
  if (scene.bodies.empty()) return stack;
  std::vector<const Body*> met;  // once only: its first surface tells
  Ray ray{point, kDirection, kInfinity, time};
  SurfacePoint surface;
  for (int i = 0; i < kMostSurfaces; ++i) {
    if (!scene.world->nearest(ray, RayKind::all, surface)) break;
    const Body* body = scene.objects[surface.object].body;
    if (body != nullptr && std::find(met.begin(), met.end(), body) == met.end()) {
      met.push_back(body);
      if (glm::dot(kDirection, surface.ng) > 0.0F) stack.enter(*body);
    }
    ray = spawn_ray(surface, kDirection);
  }
  return stack;
}

MediumStack bodies_around_lens(const Scene& scene, const Ray& ray) {
  return scene.camera->rays_are_parallel() ? media_around(scene, ray.origin, ray.time)
                                           : scene.around_camera;
}

}  // namespace hyades::core
