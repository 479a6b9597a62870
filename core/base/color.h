#pragma once

#include <string_view>

#include "core/base/result.h"
#include "core/base/vec.h"

namespace hyades::core {

/// sRGB transfer functions (IEC 61966-2-1:1999). Encoded values are display values, 0..1; linear
/// ones are proportional to light. Negative numbers mirror positive ones, numbers above 1 continue
/// the curve; a round trip returns what it began with to about 1e-6.
float srgb_decode(float encoded);  ///< display -> linear
float srgb_encode(float linear);   ///< linear -> display
Rgb srgb_decode(const Rgb& encoded);
Rgb srgb_encode(const Rgb& linear);

/// Colour of a black body of `kelvin` (clamped to 500..100,000): linear Rec.709 of luminance 1.
/// Planck's law integrated over the CIE 1931 observer (fit of Wyman et al. 2013). Below about
/// 1,900 K the colour lies outside Rec.709: negative parts are set to 0.
Rgb blackbody_color(float kelvin);

/// "#rgb" or "#rrggbb" (sRGB, as in CSS) -> linear Rec.709. The error says what was expected.
Result<Rgb> parse_hex_color(std::string_view text);

}  // namespace hyades::core
