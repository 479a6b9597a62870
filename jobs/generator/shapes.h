#pragma once

#include <vector>

#include "jobs/generator/mesh_writer.h"

namespace hyades::gallery {

/// A tube around the (p, q) torus knot (x = (2 + cos qt) cos pt, z = (2 + cos qt) sin pt, y = sin
/// qt; a classic curve), its section a circle whose radius swells in `lobes` spiralling ridges.
/// Closed; 2 * along * around triangles; smooth normals; uv.
struct KnotShape {
  int p = 2;
  int q = 3;
  float radius = 0.45F;
  int lobes = 0;
  float ridge = 0.0F;  ///< relative height of the ridges
  int twist = 0;       ///< turns of the ridges along the knot
  int along = 400;
  int around = 48;
};
Mesh make_knot(const KnotShape& shape);

/// The surface of revolution around y of a profile of (radius, y) points, a closed loop from axis
/// to axis or around; smoothed by a Catmull-Rom curve. Normals point to the right of the profile's
/// direction.
Mesh make_lathe(const std::vector<Vec2>& profile, int steps_per_span, int around);

/// A corner of a profile, rounded by an arc of `radius` (0: sharp) that touches both of its sides.
struct Corner {
  Vec2 at;
  float radius = 0.0F;
};

/// The points of a profile of straight lines and arcs; `steps` spans to an arc. Every arc has to
/// fit into its two sides. For make_lathe with one step per span.
std::vector<Vec2> round_corners(const std::vector<Corner>& corners, int steps);

}  // namespace hyades::gallery
