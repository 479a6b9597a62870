#include "core/image/tone_map.h"

#include <algorithm>
#include <array>

#include "core/base/color.h"
#include "core/base/elementary.h"

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

/// AgX's sigmoid over stops, 0..1 standing for all that it tells apart: the polynomial of
/// B. Wrensch, "Minimal AgX Implementation" (2023), whose matrices are those below.
float agx_contrast(float x) {
  return -0.00232F +
         x * (0.1191F + x * (0.4298F + x * (-6.868F + x * (31.96F + x * (-40.14F + x * 15.5F)))));
}

Rgb agx(const Rgb& color) {
  constexpr float kDarkest = -12.47393F;  // stops
  constexpr float kStops = 4.026069F - kDarkest;
  const Mat3 inset(0.842479062253094F, 0.0423282422610123F, 0.0423756549057051F,  //
                   0.0784335999999992F, 0.878468636469772F, 0.0784336F,           //
                   0.0792237451477643F, 0.0791661274605434F, 0.879142973793104F);
  const Mat3 outset(1.19687900512017F, -0.0528968517574562F, -0.0529716355144438F,
                    -0.0980208811401368F, 1.15190312990417F, -0.0980434501171241F,
                    -0.0990297440797205F, -0.0989611768448433F, 1.15107367264116F);
  Rgb mixed = inset * color;
  for (int c = 0; c < 3; ++c) {
    const float stops = core::log2(std::max(mixed[c], 1e-10F));
    mixed[c] = agx_contrast(std::clamp((stops - kDarkest) / kStops, 0.0F, 1.0F));
  }
  return glm::clamp(outset * mixed, Rgb(0.0F), Rgb(1.0F));
}

/// NaN becomes 0.
float held(float x) { return x > 0.0F ? std::min(x, kBrightest) : 0.0F; }

float map_channel(float x, ToneCurve curve) {
  x = held(x);
  switch (curve) {
    case ToneCurve::agx:  // not by channels
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
  if (name == "agx") return ToneCurve::agx;
  if (name == "linear") return ToneCurve::linear;
  return std::nullopt;
}

std::span<const std::string> tone_curve_names() {
  static const std::array<std::string, 5> names = {"srgb", "filmic", "aces", "agx", "linear"};
  return names;
}

Rgb tone_map(const Rgb& color, ToneCurve curve, float exposure) {
  const float gain = core::exp2(exposure);
  if (curve == ToneCurve::agx)
    return agx({held(color.x * gain), held(color.y * gain), held(color.z * gain)});
  return {map_channel(color.x * gain, curve), map_channel(color.y * gain, curve),
          map_channel(color.z * gain, curve)};
}

}  // namespace hyades::core
