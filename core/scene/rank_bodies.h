#pragma once

#include <cstdint>
#include <vector>

#include "core/base/bounds.h"

namespace hyades::core {

/// Where a body is, and what the job says of its rank.
struct BodyExtent {
  int32_t priority = 0;
  bool refracts = false;
  double volume = 0.0;  ///< of what the surface encloses when the shutter opens
  Bounds bounds;        ///< in the world, over the shutter interval
};

/// For each body, what it counts among all: 0 is the lowest. First comes priority; of equal ones
/// the smaller volume counts more, so that what stands within another body replaces it there; of
/// equal ones (to about 1e-4, so that no rounding decides), those that come later.
std::vector<uint32_t> rank_bodies(const std::vector<BodyExtent>& bodies);

/// For each body, whether part of its surface may be hidden: it refracts, and its bounds touch
/// those of one that refracts, too, and counts more. Never false where it is so; among thousands of
/// bodies it may be true for no need, which costs time only.
std::vector<bool> may_be_hidden(const std::vector<BodyExtent>& bodies,
                                const std::vector<uint32_t>& ranks);

}  // namespace hyades::core
