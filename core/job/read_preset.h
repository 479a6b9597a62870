#pragma once

#include "core/job/map_reader.h"

namespace hyades::core {

/// The `preset` of a medium: coefficients, phase function and index of a measured material, in the
/// job's unit of length. Complains about unknown names, and where other keys say the same.
void read_preset(MapReader& reader, MediumDesc& medium);

/// The `index` of a medium, which wins over that of its preset.
void read_index(MapReader& reader, MediumDesc& medium);

}  // namespace hyades::core
