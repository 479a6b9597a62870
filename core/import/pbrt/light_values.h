#pragma once

#include "core/import/pbrt/context.h"

namespace hyades::core::pbrt {

constexpr float kAllRound = 4.0F * kPi;  ///< steradians

/// The colour of a light as its directive says it, times `scale` and the film's exposure. Spectra
/// have luminance 1, whatever their numbers.
Rgb light_value(Context& context, const Entity& light, ParameterReader& reader, const char* name);

/// Where the job has a place of the light's own space.
Vec3 place_of(Context& context, const LightEntity& light, const Vec3d& at);

}  // namespace hyades::core::pbrt
