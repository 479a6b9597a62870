#pragma once

#include <optional>

#include "core/materials/make_material.h"

namespace hyades::core {

/// The parameters of a principled surface; docs/job.md says what each does. Numbers are within
/// 0..1 but for the indices of refraction.
struct PrincipledParams {
  ColorParam base_color{Rgb(0.8F), nullptr};
  ScalarParam metallic;
  ScalarParam roughness{0.5F, nullptr};
  ScalarParam specular{0.5F, nullptr};
  ColorParam specular_tint{Rgb(1.0F), nullptr};
  ScalarParam anisotropic;
  ScalarParam anisotropic_rotation;            ///< turns
  std::optional<ScalarParam> roughness_along;  ///< along the tangent, in place of anisotropic
  ScalarParam transmission;
  ScalarParam diffuse_transmission;  ///< of thin walls
  ScalarParam coat;
  ScalarParam coat_roughness{0.03F, nullptr};
  ScalarParam sheen;
  ColorParam sheen_tint{Rgb(1.0F), nullptr};
  ScalarParam sheen_roughness{0.5F, nullptr};
  float ior = 1.5F;
  float coat_ior = 1.5F;
  bool thin_walled = false;
  FacetScattering facets = FacetScattering::multiple;  ///< of metal and glass
  bool scale_radiance = true;  ///< by the square of the index, where glass refracts it
  bool subsurface = false;  ///< light that would be reflected by the matt part goes into the body
};

MaterialPtr make_principled(const PrincipledParams& params);

}  // namespace hyades::core
