#pragma once

#include <memory>

#include "core/media/field_place.h"
#include "core/media/medium.h"
#include "core/media/volume.h"

/// One maker per kind of medium.
namespace hyades::core {

using MediumPtr = std::shared_ptr<const Medium>;

/// What a medium is where its density is 1: absorption and scattering in 1/m, emission in
/// W/(m^3 sr), each >= 0 per channel.
struct Coefficients {
  Rgb absorption{0.0F};
  Rgb scattering{0.0F};
  Rgb emission{0.0F};

  Rgb extinction() const { return absorption + scattering; }

  /// Share of extinction that is scattering, at a place of the space of `volume`.
  Rgb albedo(const Volume& volume, const Vec3& place) const {
    const Rgb sum = extinction();
    Rgb share(0.0F);
    for (int c = 0; c < 3; ++c) {
      if (sum[c] > 0.0F) share[c] = scattering[c] / sum[c];
    }
    return volume.tint != nullptr ? share * glm::min(volume.tint->at(place), Rgb(1.0F)) : share;
  }

  /// What is given off at a place where `volume` has that density.
  Rgb glow(const Volume& volume, const Vec3& place, float density) const {
    return emission * (volume.glow != nullptr ? volume.glow->at(place) : Rgb(density));
  }
};

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
