#pragma once

#include <functional>

#include "jobs/generator/mesh_writer.h"

namespace hyades::gallery {

/// Where a distance field is looked at: a box of cubes with edges of `cell`.
struct SampledBox {
  Vec3 low{-1.0F};
  Vec3 high{1.0F};
  float cell = 0.02F;
};

/// The surface on which `distance` (negative inside) is 0, with normals from its gradient; one
/// vertex in each cube that the surface passes, in the middle of where it meets the edges (S. F.
/// Gibson 1998, "Constrained Elastic Surface Nets", without the relaxation). Closed where the field
/// is positive on the walls of the box.
Mesh make_surface(const SampledBox& box, const std::function<float(const Vec3&)>& distance);

}  // namespace hyades::gallery
