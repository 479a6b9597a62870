#pragma once

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

constexpr float kAllRound = 4.0F * kPi;  ///< steradians

/// What a light's `scale` and the film's exposure multiply its light by; an error of the report
/// where it is below 0.
float light_scale(Context& context, const Entity& light, ParameterReader& reader);

/// The colour of a light as its directive says it, times `scale` and the film's exposure. Spectra
/// have luminance 1, whatever their numbers.
Rgb light_value(Context& context, const Entity& light, ParameterReader& reader, const char* name);

/// Where the job has a place of the light's own space.
Vec3 place_of(Context& context, const LightEntity& light, const Vec3d& at);

}  // namespace hyades::core::pbrt
