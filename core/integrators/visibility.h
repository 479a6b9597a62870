#pragma once

#include "core/integrators/integrator.h"
#include "core/integrators/media_numbers.h"

namespace hyades::core {

/// An unbiased estimate of the share of light that comes along `shadow` neither blocked nor
/// scattered: 0 where a surface stands in the way; what media between, which begin and end at null
/// surfaces, let through. `around`: the bodies that the ray begins in.
Rgb visible_share(const Scene& scene, const Ray& shadow, const MediumStack& around,
                  MediaNumbers numbers, Workspace& work);

/// From a surface, or from a place in space, to the place of a light that was chosen.
Ray shadow_ray(const SurfacePoint& from, const LightSample& to);
Ray shadow_ray(const Vec3& from, const LightSample& to, float time);

/// The same as visible_share for a ray from the camera, which sees other objects than shadow rays
/// do.
Rgb visible_share_from_camera(const Scene& scene, const Ray& ray, MediaNumbers numbers,
                              Workspace& work);

/// Whether light goes on straight where it meets `object`, without an event: its surface is null,
/// or hidden in another of the bodies `around`.
inline bool lets_straight_through(const SceneObject& object, const MediumStack& around) {
  return object.material->is_null() || around.hides(object.body);
}

/// Tells `around` that a path crossed the surface of `object` at `point` towards `direction`.
void cross(const SceneObject& object, const SurfacePoint& point, const Vec3& direction,
           MediumStack& around);

}  // namespace hyades::core
