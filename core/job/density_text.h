#pragma once

#include "core/job/density_desc.h"
#include "core/job/field_writer.h"

/// What decides how media vary, as lines of a resolved job.
namespace hyades::core {

void write_transform(FieldWriter& out, const TransformList& steps);
void write_density(FieldWriter& out, const DensityDesc& density);
void write_glow(FieldWriter& out, const GlowDesc& glow);

}  // namespace hyades::core
