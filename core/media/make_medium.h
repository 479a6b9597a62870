#pragma once

#include <memory>

#include "core/media/medium.h"

/// One maker per kind of medium.
namespace hyades::core {

using MediumPtr = std::shared_ptr<const Medium>;

/// A medium that is the same everywhere. `absorption` and `scattering` in 1/m, `emission` in
/// W/(m^3 sr), each >= 0 per channel.
MediumPtr make_homogeneous(const Rgb& absorption, const Rgb& scattering, const Rgb& emission,
                           const Phase& phase);

}  // namespace hyades::core
