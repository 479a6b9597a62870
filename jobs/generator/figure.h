#pragma once

#include "jobs/generator/mesh_writer.h"

namespace hyades::gallery {

/// A kneeling man who carries a globe of radius 0.8 around (0, 2.12, -0.18) on his neck and hands,
/// facing +z; he would be 1.8 high if he stood up. Made of round limbs that flow into each other.
/// Closed.
Mesh make_atlas(float cell);

}  // namespace hyades::gallery
