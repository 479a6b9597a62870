#pragma once

#include "core/base/vec.h"

namespace hyades::core::pbrt {

/// Gradient noise by Perlin's table of 256 numbers (Perlin 2002, "Improving Noise", and its
/// reference implementation), which repeats every 256 cells: what procedural clouds are made of.
/// Within [-1, 1], 0 at lattice points.
double classic_noise(const Vec3d& p);

}  // namespace hyades::core::pbrt
