#pragma once

#include "core/job/map_reader.h"
#include "core/job/object_desc.h"

namespace hyades::core {

/// Reads `override`: names of materials, each with another material's name, or with keys that make
/// another material of it, which is added to the job. Materials have been read.
void read_overrides(MapReader& reader, ObjectDesc& object);

}  // namespace hyades::core
