#pragma once

#include <memory>

#include "core/media/coefficients.h"
#include "core/media/field_place.h"
#include "core/media/medium.h"

/// One maker per kind of medium.
namespace hyades::core {

using MediumPtr = std::shared_ptr<const Medium>;

/// A medium that is the same everywhere. `absorption` and `scattering` in 1/m, `emission` in
/// W/(m^3 sr), each >= 0 per channel.
MediumPtr make_homogeneous(const Rgb& absorption, const Rgb& scattering, const Rgb& emission,
                           const Phase& phase);

/// A medium that varies as `volume`, put into the world by `place`: absorption and scattering are
/// those of `per_density` times the density. Light scatters there times the volume's tint (what
/// that takes is absorbed). Emission is times the volume's glow.
MediumPtr make_varying(std::shared_ptr<const Volume> volume, const FieldPlace& place,
                       const Coefficients& per_density, const Phase& phase);

/// The medium of make_varying(), found by marching in steps of about `step` metres (above 0):
/// biased, for comparison.
MediumPtr make_marching(std::shared_ptr<const Volume> volume, const FieldPlace& place,
                        const Coefficients& per_density, const Phase& phase, float step);

}  // namespace hyades::core
