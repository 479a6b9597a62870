#pragma once

#include "import/pbrt/textures.h"

namespace hyades::core::pbrt {

/// Puts lights without a body into Context::lights, and what shines from infinitely far into
/// `environment` of `out`.
void add_lights(Context& context, YamlMap& out);

/// What `emit` is for a shape with area light `light`; null, and an error of the report, where it
/// cannot be said.
YamlPtr emission_node(Context& context, const Entity& light);

}  // namespace hyades::core::pbrt
