#pragma once

#include "core/import/pbrt/context.h"

namespace hyades::core::pbrt {

/// Puts `environment` into `out`: of lights without pictures a colour, else the file "sky.exr",
/// which is made of all of them.
void add_environment(Context& context, const std::vector<const LightEntity*>& lights, YamlMap& out);

/// The bytes of "sky.exr": a panorama of all infinite lights.
Result<Bytes> make_sky(const LoadedScene& scene);

/// Where a direction of unit length lies in an equal-area picture of the sphere, u and v from 0 to
/// 1 (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD").
glm::dvec2 equal_area_square(const Vec3d& direction);

/// The direction of a place in the square: the inverse.
Vec3d equal_area_direction(const glm::dvec2& place);

}  // namespace hyades::core::pbrt
