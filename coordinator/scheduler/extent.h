#pragma once

#include <cstdint>

#include "core/film/unit.h"

namespace hyades::coordinator {

/// A unit within its frame: a tile by its index in the grid.
struct Extent {
  uint32_t tile = 0;
  core::BatchRange batches;
  friend bool operator==(const Extent&, const Extent&) = default;
};

}  // namespace hyades::coordinator
