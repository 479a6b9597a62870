#pragma once

#include <optional>
#include <string>

#include "import/pbrt/context.h"

namespace hyades::core::pbrt {

/// Per unit of the scene's length.
struct Coefficients {
  Rgb absorption{0.0F};
  Rgb scattering{0.0F};
};

/// Those of a material or medium that was measured, as pbrt takes them: per millimetre. Nothing,
/// and an error of the report, where there is none.
std::optional<Coefficients> measured_coefficients(Context& context, const std::string& name,
                                                  const Place& place);

/// What parameter `name` says; textures are noted and left out.
Rgb coefficient(Context& context, ParameterReader& reader, const char* name, const Rgb& otherwise);

}  // namespace hyades::core::pbrt
