#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec.h"

namespace hyades::cli {

/// A medium that is the same everywhere, in metres.
struct KnownMedium {
  std::string name;
  std::string source;          ///< a paper or a file
  core::Rgb absorption{0.0F};  ///< 1/m
  core::Rgb scattering{0.0F};  ///< 1/m
  core::Rgb g{0.0F};           ///< mean cosine
  float index = 1.0F;          ///< of refraction
};

/// What follows from its numbers.
struct MediumFacts {
  core::Rgb extinction;         ///< 1/m
  core::Rgb mean_free_path;     ///< m; infinite where nothing happens to light
  core::Rgb transport_path;     ///< m, until light has lost its direction
  core::Rgb albedo;             ///< of a single scattering
  core::Rgb block_reflectance;  ///< of diffuse light on a half-space without a surface
  core::Rgb
      seen_reflectance;  ///< the same behind a smooth surface of its index, of the light let in
  core::Rgb in_a_layer;  ///< what of diffuse light on both sides of 1 cm of it comes out again
};

MediumFacts facts_of(const KnownMedium& medium);

/// The presets.
std::vector<KnownMedium> known_presets();

/// The preset called `name`, or the media of the file `name` (.json, .yaml), whose unit of length
/// is `units` metres. Errors tell what was expected.
core::Result<std::vector<KnownMedium>> find_media(const std::string& name, float units);

}  // namespace hyades::cli
