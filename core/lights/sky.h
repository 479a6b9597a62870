#pragma once

#include <memory>

#include "core/base/vec.h"
#include "core/lights/environment_map.h"

namespace hyades::core {

/// What decides a clear sky's picture and how it is sampled, all but the direction of the compass.
struct SkySettings {
  float elevation = 0.5F;  ///< of the sun's middle above the horizon [rad]
  float turbidity = 3.0F;  ///< as SkyModel
  Rgb ground_albedo{0.3F};
  float sun_radius = 0.0046F;  ///< angular [rad]: how much of the sun is above the horizon
  SkyDensity density = SkyDensity::luminance;  ///< of the map

  bool operator==(const SkySettings&) const = default;
};

/// A clear sky for a sun of irradiance 1 above the air.
struct Sky {
  /// Sky and ground without the sun, which stands over +x, in the middle of the picture.
  std::shared_ptr<const EnvironmentMap> map;
  Rgb sun{0.0F};  ///< irradiance of the sun's disc on a facing surface, on the ground
};

/// Finds all light of a sky (core/lights/sky_model.h). Takes some tenths of a second.
Sky make_sky(const SkySettings& settings);

/// How the radiance of the sun's disc falls off to its rim: as the power of the cosine of the angle
/// to the sun's surface (Hestroffer & Magnan 1998, "Wavelength dependency of the Solar limb
/// darkening", at 680, 550 and 440 nm).
inline const Rgb kSunLimb(0.406F, 0.508F, 0.641F);

}  // namespace hyades::core
