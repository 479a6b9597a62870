#pragma once

#include "core/base/vec.h"

/// From what a thick body of a medium looks like to its coefficients, and back.
namespace hyades::core {

/// Share of diffuse light that a half-space without a surface sends back, for single-scattering
/// albedo `albedo` (0..1) and mean cosine `g`: van de Hulst 1980, "Multiple Light Scattering",
/// section 14.3, in terms of s = sqrt((1 - albedo) / (1 - albedo g)). Within 0.003 of the exact
/// value for g = 0.
float diffuse_reflectance(float albedo, float g);

/// The inverse of diffuse_reflectance(): the albedo that sends back `reflectance` (0..1); Kulla and
/// Conty 2017, "Revisiting Physically Based Shading at Imageworks" (Physically Based Shading
/// course, SIGGRAPH), page 14.
float albedo_of_reflectance(float reflectance, float g);

/// What a smooth surface of a dielectric does to diffuse light.
struct DiffuseFresnel {
  float outer = 0.0F;  ///< share that is reflected outside
  float inner = 0.0F;  ///< share of what comes from within that is reflected back
};

/// For index `eta` > 0 inside against outside, by integrating Fresnel's equations.
DiffuseFresnel diffuse_fresnel(float eta);

/// What a half-space sends back through such a surface, of what it lets in: Saunderson 1942,
/// "Calculation of the Color of Pigmented Plastics", J. Opt. Soc. Am. 32, 727. 1 for 1.
float reflectance_through(float reflectance, float inner);

/// The inverse of reflectance_through().
float reflectance_behind(float seen, float inner);

struct BodyColor {
  Rgb color{0.0F};  ///< share of the light let in that comes back, 0..1
  Rgb radius{
      1.0F};       ///< transport mean free path 1 / (absorption + (1 - g) scattering), above 0 [m]
  float g = 0.0F;  ///< mean cosine, (-1, 1)
  float index = 1.0F;  ///< of the surface
};

struct ScatteringNumbers {
  Rgb absorption{0.0F};  ///< 1/m
  Rgb scattering{0.0F};  ///< 1/m
};

/// The coefficients of a body that looks so.
ScatteringNumbers scattering_of(const BodyColor& body);

}  // namespace hyades::core
