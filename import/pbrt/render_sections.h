#pragma once

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// Puts `film`, `sampling`, `integrator` and, where something moves, `frames` into `out`, and what
/// the film multiplies light by into the context.
void add_render_sections(Context& context, YamlMap& out);

}  // namespace hyades::core::pbrt
