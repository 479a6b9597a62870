#include "import/pbrt/spectra.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "import/pbrt/color_space.h"
#include "import/pbrt/read_parameters.h"

namespace hyades::core::pbrt {
namespace {

constexpr double kFirstWavelength = 380.0;
constexpr double kLastWavelength = 780.0;

/// The CIE 1931 observer from 380 to 780 nm by tens (CIE 15:2004, table T.4).
using Table = std::array<double, 41>;
constexpr Table kX = {0.001368, 0.004243, 0.01431,  0.04351,  0.13438,  0.2839,  0.34828,
                      0.3362,   0.2908,   0.19536,  0.09564,  0.03201,  0.0049,  0.0093,
                      0.06327,  0.1655,   0.2904,   0.43345,  0.5945,   0.7621,  0.9163,
                      1.0263,   1.0622,   1.0026,   0.85445,  0.6424,   0.4479,  0.2835,
                      0.1649,   0.0874,   0.04677,  0.0227,   0.011359, 0.00579, 0.002899,
                      0.00144,  0.00069,  0.000332, 0.000166, 83.0e-6,  42.0e-6};
constexpr Table kY = {39.0e-6, 0.00012,  0.000396, 0.00121, 0.004,    0.0116,   0.023,
                      0.038,   0.06,     0.09098,  0.13902, 0.20802,  0.323,    0.503,
                      0.71,    0.862,    0.954,    0.99495, 0.995,    0.952,    0.87,
                      0.757,   0.631,    0.503,    0.381,   0.265,    0.175,    0.107,
                      0.061,   0.032,    0.017,    0.00821, 0.004102, 0.002091, 0.001047,
                      0.00052, 0.000249, 0.00012,  60.0e-6, 30.0e-6,  15.0e-6};
constexpr Table kZ = {0.00645, 0.02005, 0.06785, 0.2074, 0.6456, 1.3856,  1.74706, 1.77211, 1.6692,
                      1.28764, 0.81295, 0.46518, 0.272,  0.1582, 0.07825, 0.04216, 0.0203,  0.00875,
                      0.0039,  0.0021,  0.00165, 0.0011, 0.0008, 0.00034, 0.00019, 50.0e-6, 20.0e-6,
                      0.0,     0.0,     0.0,     0.0,    0.0,    0.0,     0.0,     0.0,     0.0,
                      0.0,     0.0,     0.0,     0.0,    0.0};

/// Between the numbers of a table linearly; `beyond` them the last one, or nothing.
double look_up(const Table& table, double w, bool beyond) {
  const double at = (w - 380.0) / 10.0;
  if (!beyond && (at < 0.0 || at > 40.0)) return 0.0;
  const double held = std::clamp(at, 0.0, 40.0);
  const auto i = std::min(static_cast<size_t>(held), table.size() - 2);
  return std::lerp(table[i], table[i + 1], held - static_cast<double>(i));
}

Vec3d observer(double w) {
  return {look_up(kX, w, false), look_up(kY, w, false), look_up(kZ, w, false)};
}

/// D65 from 380 to 780 nm by tens (CIE S 014-2).
constexpr Table kD65Power = {49.98,  54.65,  82.75,  91.49,  93.43,  86.68,  104.86, 117.01, 117.81,
                             114.86, 115.92, 108.81, 109.35, 107.80, 104.79, 107.69, 104.41, 104.05,
                             100.00, 96.33,  95.79,  88.69,  90.01,  89.60,  87.70,  83.29,  83.70,
                             80.03,  80.21,  82.28,  78.28,  69.72,  71.61,  74.35,  61.60,  69.89,
                             75.09,  63.59,  46.42,  66.81,  63.38};

double d65(double w) { return look_up(kD65Power, w, true); }

struct Named {
  std::string_view name;
  double x, y;
};

constexpr std::array<Named, 16> kLights = {{{"stdillum-A", 0.44757, 0.40745},
                                            {"stdillum-D50", 0.34567, 0.35850},
                                            {"stdillum-D65", 0.31270, 0.32900},
                                            {"stdillum-F1", 0.31310, 0.33727},
                                            {"stdillum-F2", 0.37208, 0.37529},
                                            {"stdillum-F3", 0.40910, 0.39430},
                                            {"stdillum-F4", 0.44018, 0.40329},
                                            {"stdillum-F5", 0.31379, 0.34531},
                                            {"stdillum-F6", 0.37790, 0.38835},
                                            {"stdillum-F7", 0.31292, 0.32933},
                                            {"stdillum-F8", 0.34588, 0.35875},
                                            {"stdillum-F9", 0.37417, 0.37281},
                                            {"stdillum-F10", 0.34609, 0.35986},
                                            {"stdillum-F11", 0.38052, 0.37713},
                                            {"stdillum-F12", 0.43695, 0.40441},
                                            {"illum-acesD60", 0.32168, 0.33767}}};

struct Glass {
  std::string_view name;
  float index;
};

/// glass-F5, -F10 and -F11 are pbrt's names of SF5, SF10 and SF11.
constexpr std::array<Glass, 7> kGlasses = {{{"glass-BK7", 1.5168F},
                                            {"glass-BAF10", 1.6700F},
                                            {"glass-FK51A", 1.4866F},
                                            {"glass-LASF9", 1.8503F},
                                            {"glass-F5", 1.6727F},
                                            {"glass-F10", 1.7283F},
                                            {"glass-F11", 1.7847F}}};

/// Jobs have averages of n and k by channel, and other measurements of some metals. So that a pbrt
/// scene looks as it does there, silver, gold, copper and brass have pbrt's n at 600, 550 and 450
/// nm, and the k with which they reflect at normal incidence what its spectra do under D65: 0.972
/// 0.960 0.915, 1.022 0.783 0.343 (a red that no RGB reflects: 0.995 stands for it), 0.955 0.638
/// 0.538, 0.910 0.778 0.423. Magnesium oxide: Stephens and Malitson 1952; titanium dioxide (rutile,
/// ordinary ray): Devore 1951; both at these wavelengths.
constexpr std::array<NamedMetal, 7> kMetals = {
    {{"Ag", "", Rgb(0.15F, 0.13F, 0.14F), Rgb(4.4427F, 3.4212F, 2.3049F)},
     {"Al", "aluminium"},
     {"Au", "", Rgb(0.22F, 0.35F, 1.508F), Rgb(13.2103F, 2.1478F, 1.7019F)},
     {"Cu", "", Rgb(0.39F, 0.958F, 1.166F), Rgb(5.7428F, 2.5961F, 2.3253F)},
     {"CuZn", "", Rgb(0.45F, 0.527F, 1.094F), Rgb(4.2214F, 2.6785F, 1.788F)},
     {"MgO", "", Rgb(1.7367F, 1.7405F, 1.7524F)},
     {"TiO2", "", Rgb(2.6049F, 2.6479F, 2.8126F)}}};

}  // namespace

double Spectrum::at(double wavelength) const {
  if (wavelengths.empty() || wavelength < wavelengths.front() || wavelength > wavelengths.back()) {
    return 0.0;
  }
  const auto above = std::upper_bound(wavelengths.begin(), wavelengths.end(), wavelength);
  if (above == wavelengths.end()) return values.back();
  const auto i = static_cast<size_t>(above - wavelengths.begin());
  const double u = (wavelength - wavelengths[i - 1]) / (wavelengths[i] - wavelengths[i - 1]);
  return std::lerp(values[i - 1], values[i], u);
}

Result<Spectrum> spectrum_of_pairs(const std::vector<float>& numbers) {
  if (numbers.size() % 2 != 0) return Error{"a spectrum needs pairs of wavelength and value"};
  Spectrum out;
  for (size_t i = 0; i < numbers.size(); i += 2) {
    const auto wavelength = static_cast<double>(numbers[i]);
    if (!out.wavelengths.empty() && !(wavelength > out.wavelengths.back())) {
      return Error{"the wavelengths of a spectrum must grow"};
    }
    out.wavelengths.push_back(wavelength);
    out.values.push_back(static_cast<double>(numbers[i + 1]));
  }
  if (out.values.empty()) return Error{"the spectrum is empty"};
  return out;
}

Result<Spectrum> read_spd(std::string_view text) {
  Tokenizer tokens(text, {});
  std::vector<float> numbers;
  for (Token token = tokens.next(); token.kind != Token::Kind::end; token = tokens.next()) {
    const auto number = token.kind == Token::Kind::word ? number_of(token.text) : std::nullopt;
    if (!number || !std::isfinite(static_cast<float>(*number))) {
      return Error{std::to_string(token.line) + ":" + std::to_string(token.column) +
                   ": expected a number"};
    }
    numbers.push_back(static_cast<float>(*number));
  }
  return spectrum_of_pairs(numbers);
}

Rgb light_color(const Spectrum& spectrum) {
  Vec3d xyz(0.0);
  for (double w = kFirstWavelength; w <= kLastWavelength; w += 1.0)
    xyz += spectrum.at(w) * observer(w);
  if (!(xyz.y > 0.0)) return Rgb(0.0F);
  return without_negatives(rec709_from_xyz(xyz / xyz.y));
}

Rgb blackbody_light(double kelvin) {
  Spectrum spectrum;
  const double peak = 2.8977721e6 / std::max(kelvin, 1.0);  // nm, Wien's law
  for (double nm = kFirstWavelength; nm <= kLastWavelength; nm += 10.0) {
    spectrum.wavelengths.push_back(nm);
    const double x = 1.4387769e7 / (nm * std::max(kelvin, 1.0));
    // Over its value at the peak, so that cold bodies keep a colour.
    const double log_value = -5.0 * std::log(nm / peak) - (x > 30.0 ? x : std::log(std::expm1(x)));
    spectrum.values.push_back(std::exp(std::max(log_value, -600.0)));
  }
  return light_color(spectrum);
}

Vec3d surface_weight(double wavelength) {
  return rec709_from_xyz(d65(wavelength) * observer(wavelength));
}

Rgb surface_color(const Spectrum& spectrum) {
  Vec3d seen(0.0);
  Vec3d white(0.0);
  for (double w = kFirstWavelength; w <= kLastWavelength; w += 1.0) {
    const Vec3d weight = surface_weight(w);
    seen += spectrum.at(w) * weight;
    white += weight;
  }
  return without_negatives(seen / white);
}

std::optional<Rgb> named_light(std::string_view name) {
  for (const Named& light : kLights) {
    if (light.name == name) {
      return without_negatives(rec709_from_xyz(xyz_of_chromaticity(light.x, light.y)));
    }
  }
  return std::nullopt;
}

std::optional<float> named_glass(std::string_view name) {
  for (const Glass& glass : kGlasses) {
    if (glass.name == name) return glass.index;
  }
  return std::nullopt;
}

std::optional<NamedMetal> named_metal(std::string_view name) {
  if (!name.starts_with("metal-")) return std::nullopt;
  const bool is_k = name.ends_with("-k");
  if (!is_k && !name.ends_with("-eta")) return std::nullopt;
  const std::string_view formula = name.substr(6, name.rfind('-') - 6);
  for (NamedMetal metal : kMetals) {
    if (metal.formula != formula) continue;
    metal.is_k = is_k;
    return metal;
  }
  return std::nullopt;
}

bool is_named_spectrum(std::string_view name) {
  return named_light(name) || named_glass(name) || named_metal(name);
}

}  // namespace hyades::core::pbrt
