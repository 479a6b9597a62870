#pragma once

#include "core/job/read_context.h"

namespace hyades::core {

/// Complains about textures that hand a colour brighter than 1 to a material where colours are
/// shares of light: colours of 0 to 255, mostly. Arithmetic in between may have its reasons; what
/// is made by it is not looked at.
void check_texture_colors(ReadContext& context);

}  // namespace hyades::core
