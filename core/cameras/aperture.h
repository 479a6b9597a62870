#pragma once

#include <vector>

#include "core/base/vec.h"

namespace hyades::core {

/// The opening of a lens, inscribed in the unit circle: a disc or a regular polygon.
class Aperture {
 public:
  /// `blades` < 3: round. Else a regular polygon of that many sides (at most 64), its first corner
  /// at angle `rotation` [rad], counter-clockwise from the lens's x axis.
  Aperture(int blades, float rotation);

  /// Maps the unit square onto the opening, uniformly by area.
  Vec2 sample(const Vec2& u) const;

 private:
  std::vector<Vec2> corners_;  ///< the first one repeated at the end; empty: round
};

}  // namespace hyades::core
