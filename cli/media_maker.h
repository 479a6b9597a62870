#pragma once

#include <optional>
#include <string>

#include "cli/media_facts.h"

namespace hyades::cli {

/// Descriptions of a medium by other things than its coefficients; what is not given is empty.
/// Values of channels are "0.5", "0.9,0.6,0.4" or "#d8c8a8".
struct MediumDescription {
  std::string name = "medium";
  std::string preset;          ///< with scale: a measured medium, thicker or thinner
  std::string albedo;          ///< with mean_free_path
  std::string mean_free_path;  ///< length
  std::string color;           ///< with depth or radius
  std::string depth;           ///< length after which white light has that colour
  std::string radius;          ///< transport mean free path of a thick body of that colour
  std::optional<float> g;
  std::optional<float> index;
  float scale = 1.0F;
};

/// The medium that is meant, lengths being in units of `units` metres. The error names the option
/// that is wrong or missing.
core::Result<KnownMedium> make_described(const MediumDescription& wanted, float units);

}  // namespace hyades::cli
