#include "core/finish/tone_map.h"

#include <algorithm>

#include "core/base/color.h"
#include "core/base/elementary.h"
#include "core/job/output_names.h"

namespace hyades::core {
namespace {

// Beyond this every curve is white; keeps infinity out of the fractions below.
constexpr float kBrightest = 65504.0F;

/// Hable's curve before it is scaled to white (GDC 2010 slides; constants: his blog, "Filmic
/// Tonemapping Operators").
float hable(float x) {
  constexpr float a = 0.15F;  // shoulder strength
  constexpr float b = 0.50F;  // linear strength
  constexpr float c = 0.10F;  // linear angle
  constexpr float d = 0.20F;  // toe strength
  constexpr float e = 0.02F;  // toe numerator
  constexpr float f = 0.30F;  // toe denominator
  return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

float filmic(float x) {
  constexpr float kExposureBias = 2.0F;
  constexpr float kWhite = 11.2F;
  return hable(kExposureBias * x) / hable(kWhite);
}

float aces(float x) { return x * (2.51F * x + 0.03F) / (x * (2.43F * x + 0.59F) + 0.14F); }

float map_channel(float x, ToneCurve curve) {
  x = x > 0.0F ? std::min(x, kBrightest) : 0.0F;  // NaN too
  switch (curve) {
    case ToneCurve::srgb:
      break;
    case ToneCurve::filmic:
      x = filmic(x);
      break;
    case ToneCurve::aces:
      x = aces(x);
      break;
    case ToneCurve::linear:
      return std::min(x, 1.0F);
  }
  return std::clamp(srgb_encode(std::clamp(x, 0.0F, 1.0F)), 0.0F, 1.0F);
}

}  // namespace

std::optional<ToneCurve> find_tone_curve(std::string_view name) {
  if (name == "srgb") return ToneCurve::srgb;
  if (name == "filmic") return ToneCurve::filmic;
  if (name == "aces") return ToneCurve::aces;
  if (name == "linear") return ToneCurve::linear;
  return std::nullopt;
}

std::span<const std::string> tone_curve_names() { return tone_map_names(); }

Rgb tone_map(const Rgb& color, ToneCurve curve, float exposure) {
  const float gain = core::exp2(exposure);
  return {map_channel(color.x * gain, curve), map_channel(color.y * gain, curve),
          map_channel(color.z * gain, curve)};
}

}  // namespace hyades::core
