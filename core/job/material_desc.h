#pragma once

#include <optional>
#include <string>

#include "core/job/inputs.h"
#include "core/job/source.h"

namespace hyades::core {

struct BumpDesc {
  std::string texture;
  Animated<float> height{0.01F};  ///< length that the texture's value 1 stands for
};

struct NormalMapDesc {
  std::string texture;
  ScalarInput strength{Animated<float>(1.0F), {}};
};

/// What a principled surface has besides roughness and ior.
struct PrincipledDesc {
  ColorInput base_color{Animated<Rgb>(Rgb(0.8F)), {}};
  ScalarInput metallic{Animated<float>(0.0F), {}};
  ScalarInput specular{Animated<float>(0.5F), {}};
  ColorInput specular_tint{Animated<Rgb>(Rgb(1.0F)), {}};
  ScalarInput anisotropic{Animated<float>(0.0F), {}};
  ScalarInput anisotropic_rotation{Animated<float>(0.0F), {}};  ///< turns
  std::optional<ScalarInput> roughness_along;  ///< along the tangent, in place of anisotropic
  ScalarInput transmission{Animated<float>(0.0F), {}};
  ScalarInput diffuse_transmission{Animated<float>(0.0F), {}};
  ScalarInput coat{Animated<float>(0.0F), {}};
  ScalarInput coat_roughness{Animated<float>(0.03F), {}};
  Animated<float> coat_ior{1.5F};
  ScalarInput sheen{Animated<float>(0.0F), {}};
  ColorInput sheen_tint{Animated<Rgb>(Rgb(1.0F)), {}};
  ScalarInput sheen_roughness{Animated<float>(0.5F), {}};
  bool thin_walled = false;
  ColorInput emission_color{Animated<Rgb>(Rgb(1.0F)), {}};
  Animated<float> emission_strength{0.0F};  ///< W/(m^2 sr)

  /// Whether it may shine.
  bool emits() const {
    return !emission_strength.is_constant() || emission_strength.constant > 0.0F;
  }
};

/// What fills bodies of a material, said as one sees it; core/media/albedo_inversion.h makes
/// coefficients of it.
struct SubsurfaceDesc {
  Animated<Rgb> color{Rgb(0.8F)};   ///< share of the light that comes back out of a thick body
  Animated<Rgb> radius{Rgb(1.0F)};  ///< how far light goes until it has lost its direction [length]
  Animated<float> scale{1.0F};      ///< multiplies radius
  Animated<float> g{0.0F};          ///< mean cosine, (-1, 1)
};

struct MaterialDesc {
  std::string name;
  SourceLocation where;
  std::string type;  ///< one of material_types()
  ColorInput color{Animated<Rgb>(Rgb(0.5F)), {}};
  std::string metal = "gold";  ///< conductor: a name of the table, or "custom" with eta and k
  std::optional<Animated<Rgb>> eta, k;            ///< conductor: measured index
  bool colored = false;                           ///< conductor: `color` and `edge` count
  ColorInput edge{Animated<Rgb>(Rgb(1.0F)), {}};  ///< conductor: brightness towards the horizon
  ColorInput transmitted{Animated<Rgb>(Rgb(0.5F)), {}};  ///< diffuse-transmission
  ScalarInput roughness{Animated<float>(0.0F), {}};      ///< perceptual, alpha = roughness^2
  Animated<float> ior{1.5F};
  Animated<Rgb> transmission{Rgb(1.0F)};                  ///< dielectric: tint per crossing
  Animated<Rgb> reflection{Rgb(1.0F)};                    ///< dielectric, conductor, mirror: tint
  ScalarInput reflectiveness{Animated<float>(0.5F), {}};  ///< glossy: 0 = Lambert, 1 = lobe only
  ScalarInput glossiness{Animated<float>(0.8F), {}};      ///< glossy: sharpness of the lobe, 0..1
  /// Give back what facets shadow. Dielectrics and conductors do unless told not to, glossy
  /// surfaces only if told to.
  bool multiple_scattering = false;
  std::string first, second;  ///< materials: parts of a mix, front and back; coat, sheen: the base
  ScalarInput amount{Animated<float>(0.5F), {}};   ///< mix: share of `second`; coat
  ScalarInput opacity{Animated<float>(1.0F), {}};  ///< the rest passes straight; all but null
  std::string sides =
      "both";  ///< that the camera sees: both | front; of whole objects; all but null
  std::optional<BumpDesc> bump;
  std::optional<NormalMapDesc> normal_map;
  std::optional<PrincipledDesc> principled;
  std::optional<SubsurfaceDesc> subsurface;  ///< dielectric, principled, null: of bodies without an
                                             ///< interior
};

}  // namespace hyades::core
