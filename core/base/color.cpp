#include "core/base/color.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/elementary.h"
#include "core/base/text.h"

namespace hyades::core {
namespace {

/// One lobe of the fit: a Gaussian with different widths on its two sides.
float lobe(float wavelength, float mean, float inverse_left, float inverse_right) {
  const float t = (wavelength - mean) * (wavelength < mean ? inverse_left : inverse_right);
  return core::exp(-0.5F * t * t);
}

/// CIE 1931 2-degree colour matching functions at `nm` (Wyman, Sloan, Shirley 2013, "Simple
/// Analytic Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), listing 1).
Vec3d color_matching(float nm) {
  return {double{0.362F * lobe(nm, 442.0F, 0.0624F, 0.0374F) +
                 1.056F * lobe(nm, 599.8F, 0.0264F, 0.0323F) -
                 0.065F * lobe(nm, 501.1F, 0.0490F, 0.0382F)},
          double{0.821F * lobe(nm, 568.8F, 0.0213F, 0.0247F) +
                 0.286F * lobe(nm, 530.9F, 0.0613F, 0.0322F)},
          double{1.217F * lobe(nm, 437.0F, 0.0845F, 0.0278F) +
                 0.681F * lobe(nm, 459.0F, 0.0385F, 0.0725F)}};
}

}  // namespace

// The sums are in double so that 1 stays exactly 1.
float srgb_decode(float encoded) {
  const float x = std::fabs(encoded);
  const float y =
      x <= 0.04045F ? x / 12.92F : core::pow(static_cast<float>((double{x} + 0.055) / 1.055), 2.4F);
  return std::copysign(y, encoded);
}

float srgb_encode(float linear) {
  const float x = std::fabs(linear);
  const float y = x <= 0.0031308F
                      ? x * 12.92F
                      : static_cast<float>(1.055 * double{core::pow(x, 1.0F / 2.4F)} - 0.055);
  return std::copysign(y, linear);
}

Rgb srgb_decode(const Rgb& encoded) {
  return {srgb_decode(encoded.x), srgb_decode(encoded.y), srgb_decode(encoded.z)};
}

Rgb srgb_encode(const Rgb& linear) {
  return {srgb_encode(linear.x), srgb_encode(linear.y), srgb_encode(linear.z)};
}

Rgb blackbody_color(float kelvin) {
  constexpr float kFirst = 360.0F;
  constexpr float kLast = 830.0F;
  constexpr float kStep = 5.0F;
  constexpr double kSecondRadiation = 1.438776877e7;  // h c / k in nm K (CODATA 2018)
  const double temperature = std::isnan(kelvin) ? 6500.0 : std::clamp(double{kelvin}, 500.0, 1e5);
  const double least = kSecondRadiation / (double{kLast} * temperature);
  Vec3d xyz(0.0);
  for (float nm = kFirst; nm <= kLast; nm += kStep) {
    // Planck: lambda^-5 / (e^x - 1), times e^least so that cold bodies do not underflow; the
    // scale cancels below.
    const double x = kSecondRadiation / (double{nm} * temperature);
    const double micron = double{nm} * 1e-3;
    const double power5 = micron * micron * micron * micron * micron;
    const double radiance = double{core::exp(static_cast<float>(least - x))} /
                            (power5 * -double{core::expm1(static_cast<float>(-x))});
    xyz += radiance * color_matching(nm);
  }
  // XYZ to linear Rec.709 with a D65 white (IEC 61966-2-1).
  const Vec3d rgb(3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,
                  -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
                  0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z);
  const Vec3d inside(std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0));
  return Rgb(inside / (0.2126 * inside.x + 0.7152 * inside.y + 0.0722 * inside.z));
}

Result<Rgb> parse_hex_color(std::string_view text) {
  const Error wrong{"'" + std::string(text.substr(0, 40)) +
                    "' is not a colour: expected \"#rgb\" or \"#rrggbb\""};
  if (text.empty() || text.front() != '#') return wrong;
  const std::string_view digits = text.substr(1);
  for (const char c : digits) {
    if (hex_digit(c) < 0) return wrong;
  }
  if (digits.size() == 4 || digits.size() == 8) {
    return Error{wrong.message + "; there is no alpha here"};
  }
  if (digits.size() != 3 && digits.size() != 6) return wrong;
  Rgb color(0.0F);
  for (int i = 0; i < 3; ++i) {
    const size_t at = static_cast<size_t>(i);
    const int value = digits.size() == 3
                          ? 17 * hex_digit(digits[at])
                          : 16 * hex_digit(digits[2 * at]) + hex_digit(digits[2 * at + 1]);
    color[i] = srgb_decode(static_cast<float>(value) / 255.0F);
  }
  return color;
}

}  // namespace hyades::core
