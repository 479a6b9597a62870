#pragma once

#include <optional>

#include "core/job/job.h"
#include "core/job/map_reader.h"

namespace hyades::core {

/// The `density` of a medium where it is a map that says how it varies; else, where it is there at
/// all, it is a colour. Complains about what is wrong with the map.
void read_varying_density(MapReader& reader, std::optional<DensityDesc>& density);

/// The `emission` of a medium, a colour or a map. After the density, whose grids it may use.
void read_emission(MapReader& reader, MediumDesc& medium);

}  // namespace hyades::core
