#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"

namespace hyades::core::pbrt {

/// A quantity by wavelength [nm], linear between samples and 0 beyond them.
struct Spectrum {
  std::vector<double> wavelengths;  ///< growing
  std::vector<double> values;
  double at(double wavelength) const;
};

/// Of pairs wavelength, value; an error says what is wrong with them.
Result<Spectrum> spectrum_of_pairs(const std::vector<float>& numbers);

/// Of the text of an .spd file: pairs of numbers, comments from '#' to the line's end.
Result<Spectrum> read_spd(std::string_view text);

/// The colour of light of this spectrum, of luminance 1 in linear Rec.709 (parts outside of it are
/// 0), as the CIE 1931 observer sees it. Black where there is none.
Rgb light_color(const Spectrum& spectrum);

/// The colour of light of a black body of `kelvin` (at least 1), of luminance 1, by Planck's law.
Rgb blackbody_light(double kelvin);

/// What a surface of this reflectance, or a medium of this coefficient, is per channel: the mean of
/// the spectrum as D65 light and the observer weigh it, so that a constant stays what it is.
/// Negative parts become 0.
Rgb surface_color(const Spectrum& spectrum);

/// How much a wavelength [nm] of 380 to 780 counts in each channel of that mean; not normalised.
Vec3d surface_weight(double wavelength);

/// The chromaticity of a light that has a name ("stdillum-D65"), luminance 1, in linear Rec.709;
/// CIE 15:2004, table T.3 and T.7; ACES D60 of SMPTE ST 2065-1.
std::optional<Rgb> named_light(std::string_view name);

/// The index of refraction at 587.6 nm of a glass that has a name ("glass-BK7"), from SCHOTT's
/// catalogue.
std::optional<float> named_glass(std::string_view name);

/// "metal-Cu-eta" and "metal-Cu-k".
struct NamedMetal {
  std::string_view formula;  ///< "Cu"
  std::string_view metal;    ///< the job language's name; empty where it has none or means another
  Rgb eta{0.0F};             ///< where it has none, or another one
  Rgb k{0.0F};               ///< likewise
  bool is_k = false;
};
std::optional<NamedMetal> named_metal(std::string_view name);

/// Whether any of these knows the name.
bool is_named_spectrum(std::string_view name);

}  // namespace hyades::core::pbrt
