#pragma once

#include "core/job/density_desc.h"
#include "core/job/field_writer.h"

namespace hyades::core {

/// What decides how a medium varies, as lines of a resolved job.
void write_density(FieldWriter& out, const DensityDesc& density);

}  // namespace hyades::core
