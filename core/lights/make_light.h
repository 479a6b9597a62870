#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/world.h"
#include "core/image/image.h"
#include "core/lights/environment_map.h"
#include "core/lights/gobo.h"
#include "core/lights/light.h"
#include "core/lights/point_source.h"
#include "core/lights/surface_emission.h"

/// One maker per kind of light.
namespace hyades::core {

using LightPtr = std::shared_ptr<const Light>;

/// Light given off by placement `object` of `world`. Spheres (uniformly scaled) are sampled by
/// solid angle from outside, by area from inside; still rectangles of two triangles by solid angle;
/// everything else by area; and brighter places of an emission that varies more often. Surfaces of
/// zero area give no light. `world` must outlive the light.
LightPtr make_area_light(const World& world, uint32_t object, const SurfaceEmission& emission);

/// The area lights of the parts of one shape, as make_area_light() makes them. With `power` [W,
/// luminance] the emission's radiance is scaled so that all that they give off together is that.
std::vector<LightPtr> make_area_lights(const World& world, std::span<const uint32_t> parts,
                                       const SurfaceEmission& emission, std::optional<float> power);

/// Area of placement `object` when the shutter opens [length^2].
double surface_area(const World& world, uint32_t object);

/// Isotropic point of total flux `power` [W] per channel: intensity power / (4 pi) [W/sr].
PointSourcePtr make_point_light(const Vec3& position, const Rgb& power);

/// A spot light, as bright as a point light of flux `power` (the cone takes light away, it does not
/// gather it), but only within the cosine `cos_outer` of unit `direction`: full inside `cos_inner`,
/// with the smooth step 3 t^2 - 2 t^3 of the cosine in between.
PointSourcePtr make_spot_light(const Vec3& position, const Vec3& direction, const Rgb& power,
                               float cos_inner, float cos_outer);

/// A goniometric light: a point light of flux `power`, times what `map` has in each direction: 1
/// there is the point light itself. The columns of `axes`, orthonormal and possibly mirrored, are
/// the map's x, y (its top) and z in the world.
PointSourcePtr make_goniometric_light(const Vec3& position, const Mat3& axes, const Rgb& power,
                                      std::shared_ptr<const EnvironmentMap> map);

/// A projector: a point light of flux `power`, but only through `gobo`, whose colours it takes:
/// white is the point light itself. `fov` [radians, in (0, pi)] is the angle across the gobo's
/// shorter side. The columns of `axes`, orthonormal and possibly mirrored, lead to the gobo's right
/// and upper sides and through its middle.
PointSourcePtr make_projector_light(const Vec3& position, const Mat3& axes, const Rgb& power,
                                    float fov, std::shared_ptr<const Gobo> gobo);

/// What `source` gives off, not from its place but from all of a ball around it: placement `object`
/// of `world`, a sphere that its matrix only moves. From afar it is that source; near by its
/// shadows are soft. Within the ball there is no light of it. `world` must outlive the light.
LightPtr make_ball_light(const World& world, uint32_t object, PointSourcePtr source);

/// Sun: light travelling along unit `direction`, irradiance [W/m^2] on a facing surface, from a
/// disc of angular diameter `angle` [radians, at most pi] and uniform radiance; less than 1e-4
/// makes it a delta light. `world_radius` only serves power().
LightPtr make_sun_light(const Vec3& direction, const Rgb& irradiance, float angle,
                        float world_radius);

/// A sun with a disc that is darker at its rim: radiance in proportion to the power `limb` of
/// the cosine of the angle between the view and the normal of the sun's surface.
LightPtr make_sun_light(const Vec3& direction, const Rgb& irradiance, float angle, const Rgb& limb,
                        float world_radius);

/// Lat-long environment: direction (x, y, z) -> u = atan2(z, x) / 2pi + 0.5, v = acos(y) / pi from
/// the top, after the map has been turned by `rotate_y` [radians, counter-clockwise seen from +y];
/// values times `scale`. Bilinear; directions are chosen by `density` of what bilinear look-up
/// really returns: by luminance none has density 0 where there is light. A null image is constant
/// radiance `scale`.
LightPtr make_environment_light(std::shared_ptr<const Image> image, float rotate_y,
                                const Rgb& scale, float world_radius,
                                SkyDensity density = SkyDensity::luminance);

/// An environment light of a map that is ready: maps take time to make and can be shared between
/// frames.
LightPtr make_environment_map_light(std::shared_ptr<const EnvironmentMap> map, float rotate_y,
                                    const Rgb& scale, float world_radius);

}  // namespace hyades::core
