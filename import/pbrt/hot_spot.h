#pragma once

namespace hyades::core::pbrt {

/// A place that glows, as jobs say it: they brighten black bodies by the fourth power of the
/// temperature over 1500 K, pbrt brings their spectra to a peak of 1.
struct HotSpot {
  float kelvin = 0.0F;  ///< 0: it does not glow
  float factor = 0.0F;  ///< what the job's light is multiplied by
};

/// Of a temperature as pbrt takes it; dark up to 100 K.
HotSpot hot_spot(float kelvin);

}  // namespace hyades::core::pbrt
