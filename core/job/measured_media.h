#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec.h"

/// Real materials whose scattering was measured and published: the presets of `media`. Compiled in,
/// so that a worker knows them without a file.
namespace hyades::core {

/// A material per metre and channel, as its coefficients are used.
struct MeasuredMedium {
  std::string name;      ///< "skim-milk"
  Rgb absorption{0.0F};  ///< 1/m
  Rgb scattering{0.0F};  ///< 1/m. Where g was not measured: times (1 - g), to be used with g = 0
  Rgb g{0.0F};           ///< mean cosine of Henyey and Greenstein's phase function
  bool g_measured = false;
  float index = 1.0F;  ///< of refraction
  std::string source;  ///< the paper: "Jensen et al. 2001"
};

/// All of them: first those of Jensen, Marschner, Levoy and Hanrahan 2001, "A Practical Model for
/// Subsurface Light Transport", then those of Narasimhan, Gupta, Donner, Ramamoorthi, Nayar and
/// Jensen 2006, "Acquiring Scattering Properties of Participating Media by Dilution", in the order
/// of their tables.
std::span<const MeasuredMedium> measured_media();

/// The one called `name`; case, spaces, '-' and '_' do not matter ("Skimmilk" is "skim-milk"). Null
/// where there is none.
const MeasuredMedium* find_measured_medium(std::string_view name);

/// Their names.
const std::vector<std::string>& measured_medium_names();

}  // namespace hyades::core
