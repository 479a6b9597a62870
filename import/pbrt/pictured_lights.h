#pragma once

#include <cstddef>
#include <string>

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// Puts a goniometric light into the context's lights: a point with the picture "lights/N.exr",
/// which is made, N the number in the scene of the first light that has the same.
void add_goniometric(Context& context, size_t number, ParameterReader& reader);

/// Puts a projection into the context's lights: a projector with the scene's own picture.
void add_projection(Context& context, const LightEntity& light, ParameterReader& reader);

/// The bytes of "lights/`name`".
Result<Bytes> make_light_picture(const LoadedScene& scene, const std::string& name);

}  // namespace hyades::core::pbrt
