#pragma once

#include "core/image/image.h"

namespace hyades::gallery {

/// An evening sky as a lat-long map (width x width/2): a warm glow around a low sun, blue above, a
/// bank of clouds from fractal noise lit from the sun's side, dark ground below the horizon. Angles
/// in radians; azimuth counted as the environment look-up counts it (u = azimuth / 2pi + 0.5).
/// The sun sends the same light however wide it is: 0.035 throws shadows, 0.3 is a sun in haze.
struct SkyShape {
  int width = 512;
  float sun_elevation = 0.2F;
  float sun_azimuth = 0.0F;
  float sun_radius = 0.035F;
};
core::Image make_sky(const SkyShape& shape);

}  // namespace hyades::gallery
