#pragma once

#include "core/image/image.h"

namespace hyades::gallery {

/// A leaf with veins, R, G, B, A as display values: its foot in the middle of the upper edge (v =
/// 1), its tip below, everything else transparent.
core::Image make_leaf(int size);

/// Hexagonal floor tiles with grout: R, G, B as display values. They repeat.
core::Image make_tiles(int size);

/// The normals of these tiles, whose edges are round, brought from -1..1 to 0..1.
core::Image make_tile_normals(int size);

}  // namespace hyades::gallery
