#pragma once

#include "core/job/map_reader.h"
#include "core/job/object_desc.h"

namespace hyades::core {

/// Reads `displacement` of a mesh.
void read_displacement(MapReader& reader, ObjectDesc& object);

/// Complains about `displacement` of anything but a mesh.
void refuse_displacement(MapReader& reader, const ObjectDesc& object);

}  // namespace hyades::core
