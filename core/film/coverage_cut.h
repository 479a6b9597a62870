#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/film/coverage.h"

namespace hyades::core {

/// The canonical form (see Coverage::canonical) of the union of `boxes`. Nothing where one is empty
/// or two overlap, or where more than `max_pieces` pieces would have to be looked at: the cost is
/// small for what renderers make, but quadratic or worse for boxes chosen by an enemy.
std::optional<std::vector<CoverageBox>> cut_and_join(const std::vector<CoverageBox>& boxes,
                                                     uint64_t max_pieces);

}  // namespace hyades::core
