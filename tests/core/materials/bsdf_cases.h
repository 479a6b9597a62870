#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "core/materials/make_material.h"
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
  float ior = 1.0F;        ///< of the side z < 0 over that of z > 0
  bool reciprocal = true;  ///< false where part of it has another normal than the whole
};

inline void PrintTo(const BsdfCase& c, std::ostream* out) { *out << c.name; }

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
  return {
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
