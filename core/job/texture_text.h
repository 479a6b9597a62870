#pragma once

#include "core/job/field_writer.h"

namespace hyades::core {

/// All of a texture, for the render key.
void write_texture(FieldWriter& out, const TextureDesc& texture);

/// All of a displacement but its texture's own settings, for the render key.
void write_displacement(FieldWriter& out, const DisplacementDesc& displacement);

}  // namespace hyades::core
