#pragma once

#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>

#include "core/job/fields.h"
#include "core/job/inputs.h"
#include "core/job/kinds_of.h"
#include "core/job/metal_names.h"
#include "core/job/source.h"

/// Materials: one struct per type, each with its keys. What makes a BSDF of them stands in
/// core/scene/material_makers.cpp.
namespace hyades::core {

struct BumpDesc {
  std::string texture;
  Animated<float> height{0.01F};  ///< length that the texture's value 1 stands for
  ScalarInput strength{Animated<float>(1.0F), {}};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.texture("texture", self.texture);
    visit.animated("height", self.height, kAnyNumber.in("length"));
    visit.scalar_input("strength", self.strength, {0.0, 100.0});
  }
};

struct NormalMapDesc {
  std::string texture;
  ScalarInput strength{Animated<float>(1.0F), {}};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.texture("texture", self.texture);
    visit.scalar_input("strength", self.strength, {0.0, 100.0});
  }
};

/// What fills bodies of a material, said as one sees it; core/media/albedo_inversion.h makes
/// coefficients of it.
struct SubsurfaceDesc {
  Animated<Rgb> color{Rgb(0.8F)};   ///< share of the light that comes back out of a thick body
  Animated<Rgb> radius{Rgb(1.0F)};  ///< how far light goes until it has lost its direction
  Animated<float> scale{1.0F};      ///< multiplies radius
  Animated<float> g{0.0F};          ///< mean cosine

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.require("radius", "how far light goes in it: a length, or one for each channel");
    visit.color("color", self.color, kUnitInterval);
    visit.color("radius", self.radius, kPositive.in("length"));
    visit.animated("scale", self.scale, kPositive);
    visit.animated("g", self.g, {-1.0, 1.0, true, true});
  }
};

/// What a type of material is besides its own keys.
struct MaterialTraits {
  /// The keys that it shares with others: none; `opacity` and `sides`; those, `bump` and
  /// `normal_map`.
  enum class Shared { none, solid, surface };

  const char* type = "";  ///< its name in jobs
  Shared shared = Shared::surface;
  bool clear = false;  ///< lets light through, whatever its keys say
};

/// Matt.
struct LambertDesc {
  static constexpr MaterialTraits kTraits{"lambert"};
  ColorInput color{Animated<Rgb>(Rgb(0.5F)), {}};
  ScalarInput roughness{Animated<float>(0.0F), {}};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.color_input("color", self.color, kUnitInterval);
    visit.scalar_input("roughness", self.roughness, kUnitInterval);
  }
};

/// One material for most things, with the parameters of Burley (2012, 2015).
struct PrincipledDesc {
  static constexpr MaterialTraits kTraits{"principled"};
  ColorInput base_color{Animated<Rgb>(Rgb(0.8F)), {}};
  ScalarInput metallic{Animated<float>(0.0F), {}};
  ScalarInput roughness{Animated<float>(0.5F), {}};  ///< perceptual, alpha = roughness^2
  Animated<float> ior{1.5F};
  ScalarInput specular{Animated<float>(0.5F), {}};
  ColorInput specular_tint{Animated<Rgb>(Rgb(1.0F)), {}};
  ScalarInput anisotropic{Animated<float>(0.0F), {}};
  ScalarInput anisotropic_rotation{Animated<float>(0.0F), {}};
  std::optional<ScalarInput> roughness_along;  ///< along the tangent, in place of anisotropic
  ScalarInput transmission{Animated<float>(0.0F), {}};
  ScalarInput coat{Animated<float>(0.0F), {}};
  ScalarInput coat_roughness{Animated<float>(0.03F), {}};
  Animated<float> coat_ior{1.5F};
  ScalarInput sheen{Animated<float>(0.0F), {}};
  ColorInput sheen_tint{Animated<Rgb>(Rgb(1.0F)), {}};
  ScalarInput sheen_roughness{Animated<float>(0.5F), {}};
  bool thin_walled = false;
  bool multiple_scattering = true;  ///< of metal and glass: give back what facets shadow
  bool scale_radiance = true;       ///< by the square of the index, where glass refracts it
  ScalarInput diffuse_transmission{Animated<float>(0.0F), {}};
  ColorInput emission_color{Animated<Rgb>(Rgb(1.0F)), {}};
  Animated<float> emission_strength{0.0F};
  std::optional<SubsurfaceDesc> subsurface;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.color_input("base_color", self.base_color, kUnitInterval);
    visit.scalar_input("metallic", self.metallic, kUnitInterval);
    visit.scalar_input("roughness", self.roughness, kUnitInterval);
    visit.animated("ior", self.ior, {1.0, 100.0});
    visit.scalar_input("specular", self.specular, kUnitInterval);
    visit.color_input("specular_tint", self.specular_tint, kUnitInterval);
    visit.scalar_input("anisotropic", self.anisotropic, kUnitInterval);
    visit.scalar_input("anisotropic_rotation", self.anisotropic_rotation,
                       kUnitInterval.in("turns"));
    visit.scalar_input("roughness_along", self.roughness_along, kUnitInterval);
    visit.scalar_input("transmission", self.transmission, kUnitInterval);
    visit.scalar_input("coat", self.coat, kUnitInterval);
    visit.scalar_input("coat_roughness", self.coat_roughness, kUnitInterval);
    visit.animated("coat_ior", self.coat_ior, {1.0, 100.0});
    visit.scalar_input("sheen", self.sheen, kUnitInterval);
    visit.color_input("sheen_tint", self.sheen_tint, kUnitInterval);
    visit.scalar_input("sheen_roughness", self.sheen_roughness, kUnitInterval);
    visit.flag("thin_walled", self.thin_walled);
    visit.scalar_input("diffuse_transmission", self.diffuse_transmission, kUnitInterval);
    visit.color_input("emission_color", self.emission_color, kNotNegative);
    visit.animated("emission_strength", self.emission_strength, kNotNegative.in("W/(m² sr)"));
    visit.flag("multiple_scattering", self.multiple_scattering);
    visit.flag("scale_radiance", self.scale_radiance);
  }

  /// Whether it may shine.
  bool emits() const {
    return !emission_strength.is_constant() || emission_strength.constant > 0.0F;
  }
};

/// The surface of a body of glass.
struct DielectricDesc {
  static constexpr MaterialTraits kTraits{.type = "dielectric", .clear = true};
  bool multiple_scattering = true;  ///< give back what facets shadow
  bool scale_radiance = true;       ///< by the square of the index, where it is refracted
  ScalarInput roughness{Animated<float>(0.0F), {}};
  Animated<float> ior{1.5F};
  Animated<Rgb> transmission{Rgb(1.0F)};  ///< tint per crossing
  Animated<Rgb> reflection{Rgb(1.0F)};    ///< tint
  std::optional<SubsurfaceDesc> subsurface;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.flag("multiple_scattering", self.multiple_scattering);
    visit.flag("scale_radiance", self.scale_radiance);
    visit.scalar_input("roughness", self.roughness, kUnitInterval);
    visit.animated("ior", self.ior, {0.01, 100.0});
    visit.color("transmission", self.transmission, kUnitInterval);
    visit.color("reflection", self.reflection, kUnitInterval);
  }
};

/// A whole pane of glass, or a bubble.
struct ThinDielectricDesc {
  static constexpr MaterialTraits kTraits{.type = "thin-dielectric", .clear = true};
  ScalarInput roughness{Animated<float>(0.0F), {}};
  Animated<float> ior{1.5F};
  Animated<Rgb> transmission{Rgb(1.0F)};
  Animated<Rgb> reflection{Rgb(1.0F)};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.scalar_input("roughness", self.roughness, kUnitInterval);
    visit.animated("ior", self.ior, {0.01, 100.0});
    visit.color("transmission", self.transmission, kUnitInterval);
    visit.color("reflection", self.reflection, kUnitInterval);
  }
};

/// Metal: of the table, of a measured index, or of a colour.
struct ConductorDesc {
  static constexpr MaterialTraits kTraits{"conductor"};
  std::string metal = "gold";           ///< of metal_names_in_jobs(), or "custom" with eta and k
  std::optional<Animated<Rgb>> eta, k;  ///< both or neither
  std::optional<ColorInput> color;      ///< straight on; counts in place of an index
  ColorInput edge{Animated<Rgb>(Rgb(1.0F)), {}};  ///< beside color: towards the horizon
  ScalarInput roughness{Animated<float>(0.0F), {}};
  bool multiple_scattering = true;
  Animated<Rgb> reflection{Rgb(1.0F)};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.choice("metal", self.metal, metal_names_in_jobs());
    visit.color("eta", self.eta, {0.0, 100.0, true});
    visit.color("k", self.k, {0.0, 100.0});
    visit.color_input("color", self.color, kUnitInterval);
    visit.color_input("edge", self.edge, kUnitInterval);
    visit.scalar_input("roughness", self.roughness, kUnitInterval);
    visit.flag("multiple_scattering", self.multiple_scattering);
    visit.color("reflection", self.reflection, kUnitInterval);
  }
};

/// Matt with highlights.
struct GlossyDesc {
  static constexpr MaterialTraits kTraits{"glossy"};
  ColorInput color{Animated<Rgb>(Rgb(0.5F)), {}};
  ScalarInput reflectiveness{Animated<float>(0.5F), {}};  ///< 0: matt, 1: highlights only
  ScalarInput glossiness{Animated<float>(0.8F), {}};      ///< sharpness of the highlights
  bool multiple_scattering = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.color_input("color", self.color, kUnitInterval);
    visit.scalar_input("reflectiveness", self.reflectiveness, kUnitInterval);
    visit.scalar_input("glossiness", self.glossiness, kUnitInterval);
    visit.flag("multiple_scattering", self.multiple_scattering);
  }
};

struct MirrorDesc {
  static constexpr MaterialTraits kTraits{"mirror"};
  ColorInput color{Animated<Rgb>(Rgb(1.0F)), {}};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.color_input("color", self.color, kUnitInterval);
  }
};

/// Matt on both sides, like leaves and paper.
struct DiffuseTransmissionDesc {
  static constexpr MaterialTraits kTraits{.type = "diffuse-transmission", .clear = true};
  ColorInput color{Animated<Rgb>(Rgb(0.5F)), {}};
  ColorInput transmitted{Animated<Rgb>(Rgb(0.5F)), {}};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.color_input("color", self.color, kUnitInterval);
    visit.color_input("transmitted", self.transmitted, kUnitInterval);
  }
};

struct MixDesc {
  static constexpr MaterialTraits kTraits{"mix"};
  std::string first;
  std::string second;
  ScalarInput amount{Animated<float>(0.5F), {}};  ///< share of `second`

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.require("first", "a material's name");
    visit.require("second", "a material's name");
    visit.name_of("first", self.first, NameKind::material);
    visit.name_of("second", self.second, NameKind::material);
    visit.scalar_input("amount", self.amount, kUnitInterval);
  }
};

/// Clear varnish over another material.
struct CoatDesc {
  static constexpr MaterialTraits kTraits{"coat"};
  std::string base;
  Animated<float> ior{1.5F};
  ScalarInput roughness{Animated<float>(0.0F), {}};
  ScalarInput amount{Animated<float>(1.0F), {}};
  ColorInput color{Animated<Rgb>(Rgb(1.0F)), {}};  ///< of light that goes straight in and out

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.require("base", "a material's name");
    visit.name_of(KeyName{"base", "first"}, self.base, NameKind::material);
    visit.animated("ior", self.ior, {1.0, 100.0});
    visit.scalar_input("roughness", self.roughness, kUnitInterval);
    visit.scalar_input("amount", self.amount, kUnitInterval);
    visit.color_input("color", self.color, kUnitInterval);
  }
};

/// Fuzz over another material.
struct SheenDesc {
  static constexpr MaterialTraits kTraits{"sheen"};
  std::string base;  ///< empty: black
  ColorInput color{Animated<Rgb>(Rgb(1.0F)), {}};
  ScalarInput roughness{Animated<float>(0.5F), {}};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.name_of(KeyName{"base", "first"}, self.base, NameKind::material);
    visit.color_input("color", self.color, kUnitInterval);
    visit.scalar_input("roughness", self.roughness, kUnitInterval);
  }
};

struct TwoSidedDesc {
  static constexpr MaterialTraits kTraits{"two-sided"};
  std::string front;
  std::string back;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.require("front", "a material's name");
    visit.require("back", "a material's name");
    visit.name_of(KeyName{"front", "first"}, self.front, NameKind::material);
    visit.name_of(KeyName{"back", "second"}, self.back, NameKind::material);
  }
};

/// Strands of hair and fur.
struct HairDesc {
  static constexpr MaterialTraits kTraits{.type = "hair", .shared = MaterialTraits::Shared::solid};
  std::optional<ColorInput> color;          ///< of much hair; counts in place of what follows
  std::optional<Animated<Rgb>> absorption;  ///< per radius of a strand; in place of what follows
  Animated<float> eumelanin{1.3F};          ///< concentration of black and brown pigment
  Animated<float> pheomelanin{0.0F};        ///< of red and yellow
  ScalarInput roughness{Animated<float>(0.3F), {}};
  ScalarInput radial_roughness{Animated<float>(0.3F), {}};
  Animated<float> ior{1.55F};
  Animated<float> tilt{2.0F};  ///< of the scales

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit.color_input("color", self.color, kUnitInterval);
    visit.color("absorption", self.absorption, kNotNegative);
    visit.animated("eumelanin", self.eumelanin, kNotNegative);
    visit.animated("pheomelanin", self.pheomelanin, kNotNegative);
    visit.scalar_input("roughness", self.roughness, kUnitInterval);
    visit.scalar_input("radial_roughness", self.radial_roughness, kUnitInterval);
    visit.animated("ior", self.ior, {1.0, 100.0});
    visit.animated("tilt", self.tilt, Range{-45.0, 45.0}.in("degrees"));
  }
};

/// Lets light through as if nothing were there.
struct NullDesc {
  static constexpr MaterialTraits kTraits{
      .type = "null", .shared = MaterialTraits::Shared::none, .clear = true};
  std::optional<SubsurfaceDesc> subsurface;

  template <class Self, class Visitor>
  static void fields(Self& /*self*/, Visitor& /*visit*/) {}
};

/// Swallows all light.
struct BlackDesc {
  static constexpr MaterialTraits kTraits{.type = "black", .shared = MaterialTraits::Shared::solid};

  template <class Self, class Visitor>
  static void fields(Self& /*self*/, Visitor& /*visit*/) {}
};

using MaterialKind =
    std::variant<LambertDesc, PrincipledDesc, DielectricDesc, ThinDielectricDesc, ConductorDesc,
                 GlossyDesc, MirrorDesc, DiffuseTransmissionDesc, MixDesc, CoatDesc, SheenDesc,
                 TwoSidedDesc, HairDesc, NullDesc, BlackDesc>;

inline const std::array<std::string, 2> kMaterialSides = {"both", "front"};

struct MaterialDesc {
  std::string name;
  SourceLocation where;
  MaterialKind kind;
  ScalarInput opacity{Animated<float>(1.0F), {}};  ///< the rest passes straight
  std::string sides = "both";  ///< that the camera sees, of whole objects: of kMaterialSides
  std::optional<BumpDesc> bump;
  std::optional<NormalMapDesc> normal_map;

  /// The keys of its type, then those that types share.
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    std::visit([&](auto& kind) { fields_of(self, kind, visit); }, self.kind);
  }

 private:
  template <class Self, class Kind, class Visitor>
  static void fields_of(Self& self, Kind& kind, Visitor& visit) {
    using Shared = MaterialTraits::Shared;
    Kind::fields(kind, visit);
    if constexpr (Kind::kTraits.shared != Shared::none) {
      visit.enter_section("materials.solids");
      visit.scalar_input("opacity", self.opacity, kUnitInterval);
      visit.choice("sides", self.sides, kMaterialSides);
    }
    if constexpr (Kind::kTraits.shared == Shared::surface) {
      visit.enter_section("materials.surfaces");
      visit.map("bump", "materials.bump", self.bump);
      visit.map("normal_map", "materials.normal_map", self.normal_map);
    }
    if constexpr (requires { kind.subsurface; }) {
      visit.enter_section("materials.subsurface");
      visit.map("subsurface", "materials.subsurface.body", kind.subsurface);
    }
  }
};

/// What bodies of `material` are filled with, where it says so.
inline const SubsurfaceDesc* subsurface_of(const MaterialDesc& material) {
  return std::visit(
      [](const auto& kind) -> const SubsurfaceDesc* {
        if constexpr (requires { kind.subsurface; }) {
          return kind.subsurface ? &*kind.subsurface : nullptr;
        } else {
          return nullptr;
        }
      },
      material.kind);
}

}  // namespace hyades::core
