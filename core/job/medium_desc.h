#pragma once

#include <optional>
#include <string>

#include "core/job/density_desc.h"
#include "core/job/source.h"

namespace hyades::core {

/// What fills space. Coefficients are per unit of length; they are given as they are, or by an
/// albedo with a mean free path or an extinction coefficient.
struct MediumDesc {
  std::string name;
  SourceLocation where;
  Animated<Rgb> absorption{Rgb(0.0F)};          ///< 1/length
  Animated<Rgb> scattering{Rgb(0.0F)};          ///< 1/length
  std::optional<Animated<Rgb>> albedo;          ///< scattering / (absorption + scattering)
  std::optional<Animated<Rgb>> mean_free_path;  ///< length
  std::optional<Animated<Rgb>> density;         ///< absorption + scattering, 1/length
  std::string phase = "henyey-greenstein";      ///< henyey-greenstein | rayleigh
  Animated<Rgb> g{Rgb(0.0F)};                   ///< mean cosine, (-1, 1)
  Animated<Rgb> g2{Rgb(0.0F)};                  ///< of a second lobe
  Animated<float> blend{0.0F};                  ///< share of the second lobe
  Animated<Rgb> emission{Rgb(0.0F)};            ///< W/(length^3 sr)
  Animated<float> scale{1.0F};                  ///< multiplies all coefficients
  Animated<float> emission_strength{1.0F};      ///< multiplies emission
  std::optional<DensityDesc> varying;           ///< multiplies them from place to place in a body
  std::optional<GlowDesc> glow;                 ///< where emission varies in its own way
  std::string light_group;                      ///< of what it gives off; empty: none
  std::optional<Animated<float>> index;  ///< of refraction, of bodies of it that have no material
};

}  // namespace hyades::core
