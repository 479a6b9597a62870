#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/job/density_desc.h"
#include "core/job/fields.h"
#include "core/job/source.h"

namespace hyades::core {

/// What a medium gives off.
struct EmissionDesc {
  Animated<Rgb> color{Rgb(1.0F)};
  Animated<float> strength{1.0F};  ///< multiplies color
  std::string grid;                ///< of the density's vdb, multiplies color; empty: none
  std::string temperature;         ///< grid of the density's vdb; empty: none
  Animated<float> kelvin{1.0F};    ///< what its value 1 stands for

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.color(KeyName{"color", "emission"}, self.color, kNotNegative);
    visit.animated(KeyName{"strength", "emission_strength"}, self.strength,
                   kNotNegative.in("W/(length³ sr)"));
    visit.text(KeyName{"grid", "glow.grid"}, self.grid, "the name of a grid of numbers");
    visit.text(KeyName{"temperature", "glow.temperature"}, self.temperature,
               "the name of a grid of numbers");
    visit.animated(KeyName{"kelvin", "glow.kelvin"}, self.kelvin, kPositive.in("K"));
  }

  /// Whether it varies in its own way.
  bool has_grids() const { return !grid.empty() || !temperature.empty(); }
};

inline const std::array<std::string, 2> kPhaseNames = {"henyey-greenstein", "rayleigh"};

/// What fills space. Coefficients are per unit of length; they are given as they are, or by an
/// albedo with a mean free path or an extinction coefficient.
struct MediumDesc {
  std::string name;
  SourceLocation where;
  std::optional<DensityDesc> varying;  ///< multiplies coefficients from place to place in a body
  Animated<Rgb> absorption{Rgb(0.0F)};
  Animated<Rgb> scattering{Rgb(0.0F)};
  std::optional<Animated<Rgb>> albedo;  ///< scattering / (absorption + scattering)
  std::optional<Animated<Rgb>> mean_free_path;
  std::optional<Animated<Rgb>> density;  ///< absorption + scattering
  std::string phase = kPhaseNames[0];    ///< of kPhaseNames
  Animated<Rgb> g{Rgb(0.0F)};            ///< mean cosine
  Animated<Rgb> g2{Rgb(0.0F)};           ///< of a second lobe
  Animated<float> blend{0.0F};           ///< share of the second lobe
  std::optional<Animated<float>> index;  ///< of refraction, of bodies of it without a material
  std::optional<EmissionDesc> emission;
  Animated<float> scale{1.0F};  ///< multiplies all coefficients
  std::string light_group;      ///< of what it gives off; empty: none

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    constexpr Range kCosine{-1.0, 1.0, true, true};
    visit.map_beside_value("density", "media.density", self.varying);
    visit.preset("preset", self);
    visit.color("absorption", self.absorption, kNotNegative.in("1/length"));
    visit.color("scattering", self.scattering, kNotNegative.in("1/length"));
    visit.color("albedo", self.albedo, kUnitInterval);
    visit.color("mean_free_path", self.mean_free_path, kPositive.in("length"));
    if (!self.varying) visit.color("density", self.density, kNotNegative.in("1/length"));
    visit.choice("phase", self.phase, kPhaseNames);
    visit.color("g", self.g, kCosine);
    visit.color("g2", self.g2, kCosine);
    visit.animated("blend", self.blend, kUnitInterval);
    visit.animated("index", self.index, {0.01, 100.0});
    visit.color_or_map(KeyName{"emission", ""}, "media.emission", self.emission, kNotNegative);
    visit.animated("scale", self.scale, kNotNegative);
    visit.light_group("light_group", self.light_group);
  }
};

}  // namespace hyades::core
