#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "core/materials/make_hair.h"
#include "core/materials/make_layers.h"
#include "core/materials/make_material.h"
#include "core/materials/make_matt.h"
#include "core/materials/make_principled.h"
#include "tests/core/materials/test_textures.h"

namespace hyades::core {

/// A material's BSDF at a plain surface point (normal +z, tangents +x and +y).
class BsdfUnderTest {
 public:
  explicit BsdfUnderTest(MaterialPtr material) : material_(std::move(material)) {
    bsdf_ = material_->bsdf_at(point_, frame_, arena_);
  }
  BsdfUnderTest(const BsdfUnderTest&) = delete;
  BsdfUnderTest& operator=(const BsdfUnderTest&) = delete;

  const Bsdf* operator->() const { return bsdf_; }
  const Bsdf* get() const { return bsdf_; }

 private:
  MaterialPtr material_;
  SurfacePoint point_;
  Frame frame_;
  BsdfArena arena_;
  const Bsdf* bsdf_ = nullptr;
};

inline ColorParam color_of(const Rgb& value) { return {value, nullptr}; }
inline ScalarParam number(float value) { return {value, nullptr}; }

struct BsdfCase {
  std::string name;
  MaterialPtr material;
  float ior = 1.0F;        ///< of the side z < 0 over that of z > 0; 1 over it if not scaled
  bool reciprocal = true;  ///< false where part of it has another normal than the whole
  bool scaled = true;      ///< refraction scales radiance as physics has it, not importance
};

inline void PrintTo(const BsdfCase& c, std::ostream* out) { *out << c.name; }

/// A principled material after `change`.
template <class Change>
MaterialPtr principled_with(const Change& change) {
  PrincipledParams params;
  params.base_color.value = {0.8F, 0.5F, 0.2F};
  change(params);
  return make_principled(params);
}

inline std::vector<BsdfCase> principled_cases() {
  using P = PrincipledParams;
  return {
      {"principled", principled_with([](P&) {})},
      {"principled_shiny", principled_with([](P& p) {
         p.roughness.value = 0.2F;
         p.specular.value = 0.9F;
         p.specular_tint.value = {0.3F, 0.9F, 0.6F};
       })},
      {"principled_brushed_metal", principled_with([](P& p) {
         p.metallic.value = 1.0F;
         p.roughness.value = 0.5F;
         p.anisotropic.value = 0.8F;
         p.anisotropic_rotation.value = 0.15F;
         p.specular_tint.value = {0.9F, 0.5F, 0.7F};
       })},
      {"principled_loses_light", principled_with([](P& p) {
         p.metallic.value = 0.5F;
         p.transmission.value = 1.0F;
         p.roughness.value = 0.8F;
         p.coat.value = 0.5F;
         p.coat_roughness.value = 0.4F;
         p.facets = FacetScattering::single;
       }),
       1.5F},
      {"principled_rough_along", principled_with([](P& p) {
         p.metallic.value = 0.5F;
         p.roughness.value = 0.4F;
         p.roughness_along = ScalarParam{0.9F, nullptr};
       })},
      {"principled_coat_and_fuzz", principled_with([](P& p) {
         p.metallic.value = 0.3F;
         p.coat.value = 0.8F;
         p.coat_roughness.value = 0.3F;
         p.sheen.value = 0.7F;
         p.sheen_tint.value = {0.6F, 0.8F, 1.0F};
         p.anisotropic.value = 0.5F;
       })},
      {"principled_polished", principled_with([](P& p) {
         p.roughness.value = 0.0F;
         p.coat.value = 1.0F;
         p.coat_roughness.value = 0.0F;
         p.metallic.value = 0.4F;
       })},
      {"principled_half_glass", principled_with([](P& p) {
         p.transmission.value = 0.6F;
         p.roughness.value = 0.6F;
         p.coat.value = 0.5F;
         p.coat_roughness.value = 0.4F;
       }),
       1.5F},
      {"principled_leaf", principled_with([](P& p) {
         p.thin_walled = true;
         p.transmission.value = 0.3F;
         p.diffuse_transmission.value = 0.4F;
         p.sheen.value = 0.4F;
       })},
  };
}

inline std::vector<BsdfCase> layered_cases() {
  const MaterialPtr red = make_lambert(color_of({0.8F, 0.3F, 0.1F}));
  const auto coated = [](MaterialPtr base, float roughness, const Rgb& color) {
    CoatParams params;
    params.roughness.value = roughness;
    params.color.value = color;
    params.amount.value = 0.9F;
    return make_coat(std::move(base), params);
  };
  const MaterialPtr copper =
      make_colored_conductor(color_of({0.95F, 0.6F, 0.5F}), color_of({0.3F, 0.6F, 0.9F}),
                             number(0.5F), Rgb(1.0F), FacetScattering::multiple);
  const MaterialPtr leaf =
      make_diffuse_transmission(color_of({0.2F, 0.5F, 0.3F}), color_of({0.4F, 0.3F, 0.6F}));
  return {
      {"rough_matt", make_rough_matt(color_of({0.8F, 0.5F, 0.2F}), number(0.8F))},
      {"diffuse_transmission", leaf},
      {"rough_pane", make_thin_dielectric(1.5F, {0.9F, 0.7F, 0.5F}, Rgb(1.0F), number(0.5F))},
      {"colored_metal", copper},
      {"coat_over_paint", coated(red, 0.3F, {0.9F, 0.8F, 0.4F})},
      {"smooth_coat_over_metal", coated(copper, 0.0F, Rgb(1.0F))},
      {"coat_over_glass",
       coated(make_rough_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(0.5F)), 0.4F,
              {0.5F, 0.8F, 1.0F}),
       1.5F},
      {"sheen_over_black", make_sheen(make_black(), color_of({1.0F, 0.8F, 0.6F}), number(0.4F))},
      {"velvet", make_sheen(red, color_of({0.9F, 0.9F, 1.0F}), number(0.6F))},
      {"two_sided", make_two_sided(copper, red)},
      {"coat_over_sides_that_differ_and_a_leaf",
       coated(make_mix(make_two_sided(copper, red), leaf, number(0.5F)), 0.4F, Rgb(1.0F))},
  };
}

/// Strands; they are not the same both ways.
inline std::vector<BsdfCase> hair_cases() {
  const auto hair = [](float roughness, float radial_roughness, const Rgb& absorption) {
    HairParams params;
    params.absorption = absorption;
    params.roughness.value = roughness;
    params.radial_roughness.value = radial_roughness;
    return make_hair(params);
  };
  return {
      {"hair", hair(0.3F, 0.3F, melanin_absorption(1.3F, 0.2F)), 1.0F, false},
      {"hair_white", hair(0.5F, 0.7F, Rgb(0.0F)), 1.0F, false},
      {"hair_wild", hair(1.0F, 1.0F, {0.1F, 0.5F, 2.0F}), 1.0F, false},
  };
}

/// Materials that scatter smoothly, some with delta lobes beside.
inline std::vector<BsdfCase> smooth_cases() {
  const MetalIndex gold = *find_metal("gold");
  const auto metal = [&](float roughness) {
    return make_conductor(gold.eta, gold.k, number(roughness), Rgb(1.0F));
  };
  const MaterialPtr red = make_lambert(color_of({0.8F, 0.3F, 0.1F}));
  const MaterialPtr glass = make_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F));
  const auto glossy = [](float reflectiveness, float glossiness) {
    return make_glossy(color_of({0.9F, 0.6F, 0.5F}), number(reflectiveness), number(glossiness));
  };
  const auto full_glass = [](float ior, float roughness) {
    return make_rough_dielectric(ior, Rgb(1.0F), Rgb(1.0F), number(roughness),
                                 FacetScattering::multiple);
  };
  std::vector<BsdfCase> cases = {
      {"lambert", red},
      {"conductor_rough_01", metal(0.1F)},
      {"conductor_rough_03", metal(0.3F)},
      {"conductor_rough_10", metal(1.0F)},
      {"conductor_full",
       make_conductor(gold.eta, gold.k, number(0.8F), Rgb(1.0F), FacetScattering::multiple)},
      {"glossy_full", make_glossy(color_of({1.0F, 0.6F, 0.5F}), number(0.7F), number(0.3F),
                                  FacetScattering::multiple)},
      {"glossy_dull", glossy(0.3F, 0.2F)},
      {"glossy_sharp", glossy(0.6F, 0.8F)},
      {"glossy_lobe", glossy(1.0F, 0.5F)},
      {"glossy_mirror", glossy(0.4F, 1.0F)},
      {"rough_glass_02", make_rough_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(0.2F)), 1.5F},
      {"rough_glass_06", make_rough_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(0.6F)), 1.5F},
      {"rough_glass_tinted",
       make_rough_dielectric(1.33F, {0.9F, 0.5F, 0.2F}, {0.3F, 0.6F, 0.4F}, number(0.9F)), 1.33F},
      {"rough_bubble", make_rough_dielectric(0.7F, Rgb(1.0F), Rgb(1.0F), number(0.5F)), 0.7F},
      {"rough_glass_full_03", full_glass(1.5F, 0.3F), 1.5F},
      {"rough_glass_full_10", full_glass(1.5F, 1.0F), 1.5F},
      {"rough_glass_full_nearly_matched", full_glass(1.02F, 0.7F), 1.02F},
      {"rough_bubble_full", full_glass(0.5F, 0.8F), 0.5F},
      {"rough_glass_full_tinted",
       make_rough_dielectric(1.33F, {0.9F, 0.5F, 0.2F}, {0.3F, 0.6F, 0.4F}, number(0.9F),
                             FacetScattering::multiple),
       1.33F},
      {"rough_glass_unscaled",
       make_rough_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(0.5F), FacetScattering::single,
                             false),
       1.0F / 1.5F, true, false},
      {"rough_glass_full_unscaled",
       make_rough_dielectric(1.4F, Rgb(1.0F), Rgb(1.0F), number(0.7F), FacetScattering::multiple,
                             false),
       1.0F / 1.4F, true, false},
      {"mix_lambert_metal", make_mix(red, metal(0.4F), number(0.3F))},
      {"mix_lambert_glass", make_mix(red, glass, number(0.4F)), 1.5F},
      {"mix_lambert_null", make_mix(make_null(), red, number(0.7F))},
      {"mix_rough_glass_metal",
       make_mix(make_rough_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(0.5F)), metal(0.5F),
                number(0.5F)),
       1.5F},
      {"mix_turned",
       make_mix(red, make_bump(metal(0.5F), object_slope({0.4F, -0.2F, 0.0F}), 1.0F), number(0.5F)),
       1.0F, false},
      {"mix_nested",
       make_mix(make_mix(red, metal(0.5F), number(0.5F)), glossy(0.5F, 0.5F), number(0.25F))},
  };
  for (const auto& more : {principled_cases(), layered_cases(), hair_cases()})
    cases.insert(cases.end(), more.begin(), more.end());
  return cases;
}

struct NamedDirection {
  const char* name;
  Vec3 wo;
};

/// From where surfaces are looked at: straight, obliquely, grazing, from inside, and from inside
/// where glass reflects totally.
inline std::vector<NamedDirection> five_directions() {
  const auto unit = [](float x, float y, float z) { return glm::normalize(Vec3(x, y, z)); };
  return {{"normal", unit(0.0F, 0.0F, 1.0F)},
          {"oblique", unit(0.6F, -0.4F, 0.7F)},
          {"grazing", unit(-0.9F, 0.4F, 0.03F)},
          {"inside", unit(0.3F, 0.2F, -0.9F)},
          {"total_reflection", unit(0.7F, 0.6F, -0.3F)}};
}

inline constexpr TransportMode kBothModes[] = {TransportMode::radiance, TransportMode::importance};

}  // namespace hyades::core
