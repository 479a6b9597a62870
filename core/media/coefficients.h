#pragma once

#include <algorithm>

#include "core/media/volume.h"

namespace hyades::core {

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

}  // namespace hyades::core
