#pragma once

#include <cstddef>
#include <string>

#include "core/base/result.h"
#include "core/geometry/world.h"

namespace hyades::core {

/// Largest coordinate of anything in a world, and largest one of a ray's origin: beyond, Embree's
/// products of lengths overflow (it aborts on rays beyond 1.8e18 in an instance's space).
inline constexpr float kLargestCoordinate = 1e12F;
inline constexpr float kRayReach = 1e13F;

/// Errors: no mesh, a size that is not positive, no transform or too many, one that is not finite,
/// or that takes the shape beyond kLargestCoordinate. Singular transforms are fine: they flatten
/// meshes, and quadrics vanish.
Status check_placement(const Placement& p);

/// Whether rays can be transformed into the object's space at any time of the shutter: its matrix
/// nowhere comes near to being singular. If not, its vertices are transformed instead.
bool can_be_instanced(const Placement& p);

/// Whether rays can be transformed by `to_world`, of what stands still, into the object's space.
bool can_be_instanced(const Mat4& to_world);

/// "object 3 (bunny.obj)", for messages.
std::string describe_placement(const Placement& p, size_t number);

}  // namespace hyades::core
