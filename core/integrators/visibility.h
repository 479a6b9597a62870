#pragma once

#include <cstdint>

#include "core/integrators/integrator.h"
#include "core/integrators/media_numbers.h"

namespace hyades::core {

/// An unbiased estimate of the share of light that comes along `shadow` neither blocked nor
/// scattered: 0 where a surface stands in the way; what surfaces that are not all there and
/// media between, which begin and end at null surfaces, let through. `around`: the bodies that the
/// ray begins in; `blockers`: the list of objects that cast shadows in the light.
Rgb visible_share(const Scene& scene, const Ray& shadow, const MediumStack& around,
                  MediaNumbers numbers, Workspace& work, uint8_t blockers = 0);

/// From a surface, or from a place in space, to the place of a light that was chosen.
Ray shadow_ray(const SurfacePoint& from, const LightSample& to);
Ray shadow_ray(const Vec3& from, const LightSample& to, float time);

/// An unbiased estimate of the share of light that comes along `ray`, one from the camera, which
/// sees other objects than shadow rays do.
Rgb visible_share_from_camera(const Scene& scene, const Ray& ray, MediaNumbers numbers,
                              Workspace& work);

/// The share of the light that goes on straight where it meets `object` at `point`, without an
/// event: all where its surface is null, or hidden in another of the bodies `around`; else what its
/// opacity leaves.
inline float straight_share(const SceneObject& object, const SurfacePoint& point,
                            const MediumStack& around) {
  const Material& material = *object.material;
  if (material.is_null() || around.hides(object.body)) return 1.0F;
  return material.is_cutout() ? 1.0F - material.opacity(point) : 0.0F;
}

/// Whether a ray of `kind` along `direction` does not see `object`, whose surface it meets at
/// `point`: the camera looks through the backs of what shows it its front only.
inline bool is_unseen(const SceneObject& object, const SurfacePoint& point, const Vec3& direction,
                      RayKind kind) {
  return object.front_only && kind == RayKind::camera && glm::dot(direction, point.ng) > 0.0F;
}

/// Whether a path goes on straight there, which it does with probability straight_share().
inline bool goes_straight(const SceneObject& object, const SurfacePoint& point,
                          const MediumStack& around, MediaNumbers& numbers) {
  const float share = straight_share(object, point, around);
  return share >= 1.0F || (share > 0.0F && numbers.next_number() < share);
}

/// Takes the bodies out of `around` that rays of `kind` do not see: those are not in them.
inline void keep_seen(const Scene& scene, RayKind kind, MediumStack& around) {
  if (!scene.hides_bodies) return;
  around.keep(
      [&](const Body& body) { return meet(scene.world->placement(body.object).seen_by, kind); });
}

/// Whether `object` casts shadows in the light of lights whose blockers are list `blockers`.
inline bool is_blocker(const SceneObject& object, uint8_t blockers) {
  return is_in(object.in_lists, blockers);
}

/// Takes out of `around` what is not on the list `blockers`, the atmosphere too.
void keep_blockers(const Scene& scene, uint8_t blockers, MediumStack& around);

/// Tells `around` that a path crossed the surface of `object` at `point` towards `direction`.
void cross(const SceneObject& object, const SurfacePoint& point, const Vec3& direction,
           MediumStack& around);

}  // namespace hyades::core
