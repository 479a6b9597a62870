#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/vec.h"

namespace hyades::core {

/// How light becomes the numbers of a display, after exposure, from linear Rec.709: channel by
/// channel, but for AgX, which mixes them first, so that bright colours fade to white.
enum class ToneCurve {
  srgb,    ///< the sRGB encoding alone: 1 is white, what is brighter is clipped
  filmic,  ///< Hable 2010, "Uncharted 2: HDR Lighting" (GDC), white at 11.2, then sRGB encoding
  aces,    ///< Narkowicz 2015, "ACES Filmic Tone Mapping Curve", then sRGB encoding
  agx,  ///< Sobotka 2022, "AgX", as Wrensch 2023 fitted it; for 2.2, which displays take for sRGB
  linear,  ///< no encoding: the numbers themselves, clipped (data, not pictures)
};

/// The curve called `name` in jobs, if there is one.
std::optional<ToneCurve> find_tone_curve(std::string_view name);

/// The names of all curves.
std::span<const std::string> tone_curve_names();

/// Display value, 0..1, of linear `color` brightened by `exposure` stops (a factor of 2 each).
/// Negative parts and NaN become 0, infinity becomes white.
Rgb tone_map(const Rgb& color, ToneCurve curve, float exposure);

}  // namespace hyades::core
