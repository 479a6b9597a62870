#pragma once

#include "core/import/pbrt/context.h"

namespace hyades::core::pbrt {

/// Puts the media that something uses into Context::media, each once.
class Media {
 public:
  explicit Media(Context& context);

  /// The job's name of a medium of the scene; empty where `name` is, and, with an error of the
  /// report, where there is none of that name.
  std::string named(const std::string& name, const Place& place);

 private:
  Context& context_;
  std::unordered_map<std::string, size_t> by_name_;
  std::unordered_map<std::string, std::string> written_;
};

/// The coefficients of a material or medium that was measured, per unit of length as pbrt takes
/// them: those per millimetre. Nothing, and an error of the report, where there is none.
struct Coefficients {
  Rgb absorption{0.0F};
  Rgb scattering{0.0F};
};
std::optional<Coefficients> measured_coefficients(Context& context, const std::string& name,
                                                  const Place& place);

/// The medium of a subsurface material; its name.
std::string add_subsurface_medium(Context& context, ParameterReader& material, float scale, float g,
                                  const std::string& wish);

}  // namespace hyades::core::pbrt
