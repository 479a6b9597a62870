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
  struct Met {
    uint32_t object;
    bool from_within;
  };
  std::vector<Met> met;  // the first surface of every body, nearest first
  Ray ray{point, kDirection, kInfinity, time};
  SurfacePoint surface;
  for (int i = 0; i < kMostSurfaces; ++i) {
    if (!scene.world->nearest(ray, RayKind::other, surface)) break;
    const uint32_t body = scene.objects[surface.object].body;
    const bool known = std::any_of(
        met.begin(), met.end(), [&](const Met& m) { return scene.objects[m.object].body == body; });
    if (body != SceneObject::kNoBody && !known) {
      met.push_back({surface.object, glm::dot(kDirection, surface.ng) > 0.0F});
    }
    ray = spawn_ray(surface, kDirection);
    ray.time = time;
  }
  MediumStack stack(scene.atmosphere.get());
  for (auto m = met.rbegin(); m != met.rend(); ++m) {
    const SceneObject& object = scene.objects[m->object];
    if (m->from_within) stack.enter(object.body, object.interior.get(), object.material->is_null());
  }
  return stack;
}

}  // namespace hyades::core
