#pragma once

#include <optional>

#include "core/materials/make_material.h"

namespace hyades::core {

/// How strands scatter light.
struct HairParams {
  /// Per radius of the strand: what light loses on its way through. Where `color` has a value, it
  /// is found from that.
  Rgb absorption{0.0F};
  std::optional<ColorParam> color;  ///< of much hair, after all scattering between strands: 0..1
  ScalarParam roughness{0.3F, {}};  ///< along the strand, 0..1
  ScalarParam radial_roughness{0.3F, {}};  ///< around it, 0..1
  float ior = 1.55F;                       ///< above 1
  float tilt = 2.0F;  ///< of the scales' surfaces, whose normals lean to the root [degrees]
};

/// Hair and fur: Chiang, Bitterli, Tappan and Burley 2016, "A Practical and Controllable Hair and
/// Fur Model for Production Path Tracing", of rays that are mirrored, go through, are mirrored once
/// within and all others. Strands lie along the surface's tangent of growing u; where a ray meets
/// one beside its axis follows from the normal.
MaterialPtr make_hair(const HairParams& params);

/// The absorption of hair with these concentrations of pigment (d'Eon et al. 2011, "An
/// Energy-Conserving Hair Reflectance Model", section 6.1; 1.3 of eumelanin is brown).
Rgb melanin_absorption(float eumelanin, float pheomelanin);

/// The absorption that gives much hair the colour (Chiang et al. 2016, section 4.2).
Rgb hair_absorption(const Rgb& color, float radial_roughness);

}  // namespace hyades::core
