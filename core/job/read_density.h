#pragma once

#include "core/job/density_desc.h"
#include "core/job/map_reader.h"

namespace hyades::core {

/// The `density` of a medium where it is a map that says how it varies; else, where it is there at
/// all, it is a colour. Complains about what is wrong with the map.
void read_varying_density(MapReader& reader, std::optional<DensityDesc>& density);

}  // namespace hyades::core
