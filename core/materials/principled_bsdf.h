#pragma once

#include <optional>

#include "core/materials/anisotropic_energy.h"
#include "core/materials/bsdf.h"
#include "core/materials/coat_lobe.h"
#include "core/materials/fresnel.h"
#include "core/materials/layer_loss.h"

namespace hyades::core {

/// A surface of many parts at one place, in the manner of Burley 2012 ("Physically Based Shading at
/// Disney") and 2015, layered as OpenPBR 1.1 (Academy Software Foundation 2024) has it:
///
///   fuzz over coat over (metallic metal + (1 - metallic) (transmission glass
///                        + (1 - transmission) (dielectric facets over matt)))
///
/// Layers share the light by tables of what each reflects, E(w), so that nothing is lost or made:
/// what lies beneath gets T(w) = 1 - E(w). Layers over the matt part weigh it by T(o) T(i) / mean
/// T, which is reciprocal, and with which a white surface gives back everything (Kulla and Conty
/// 2017); of T all layers together are meant, whose mean is found by quadrature. Everything else
/// they weigh by the lesser of T(o) and T(i), which is exact for mirrors. What that loses of wider
/// lobes is given back (layer_loss.h): what the facets over the matt part lose goes to the matt
/// part, what metal and glass lose is a part of its own.
struct PrincipledParts {
  float metallic = 0.0F;
  float glassy = 0.0F;            ///< share of what is no metal
  AnisotropicGgx facets;          ///< of the metal and over the matt part
  float alpha = 0.25F;            ///< roughness^2
  float eta = 1.5F;               ///< relative index of the facets over the matt part
  Rgb facet_tint{1.0F};           ///< of these facets
  Rgb metal{1.0F};                ///< reflectance of the metal seen straight on
  Rgb metal_edge{1.0F};           ///< tint of what it reflects at 82 degrees
  bool metal_keeps_light = true;  ///< what its facets throw onto each other
  Rgb matt{0.8F};                 ///< reflectance of the matt part
  Rgb matt_through{0.0F};         ///< its transmittance (of thin walls)
  const Bsdf* glass = nullptr;
  bool solid = false;  ///< a body: coat and fuzz lie on the outer side only
  std::optional<CoatLobe> coat;
  std::optional<FuzzLobe> fuzz;
};

class PrincipledBsdf final : public Bsdf {
 public:
  explicit PrincipledBsdf(const PrincipledParts& parts);

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const override;
  Rgb evaluate_diffuse(const Vec3& wo, const Vec3& wi) const override;
  float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const override;
  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override;
  Rgb albedo(const Vec3& wo) const override;
  Spread spread(float outer) const override;
  bool has_smooth() const override;

 private:
  /// What one direction has to do with the layers.
  struct Layers {
    float fuzz = 0.0F;     ///< share that the fuzz reflects
    float coat = 0.0F;     ///< of the rest, what the coat does
    float beneath = 1.0F;  ///< what is left
  };

  /// Probabilities of lobes.
  struct Lobes {
    float fuzz = 0.0F;
    float coat = 0.0F;
    float facets = 0.0F;
    float cosine = 0.0F;  ///< matt, and what the metal's facets throw onto each other
    float through = 0.0F;
    float glass = 0.0F;
  };

  bool layered(const Vec3& w) const { return !parts_.solid || w.z >= 0.0F; }
  Layers layers_of(const Vec3& w) const;
  bool stretched() const { return parts_.facets.along_x != parts_.facets.along_y; }
  float facet_share(const Vec3& o) const;
  float mean_rest(bool covered) const;
  float rest(const Layers& layers, const Vec3& w) const;
  const LayerLight* lost_light(const Vec3& w) const;
  void give_back_what_layers_lose();
  Spread spread_beneath() const;
  bool mirrors() const { return parts_.alpha < Ggx::kLeastAlpha; }
  Rgb metal_reflectance(float cosine) const;
  Rgb mean_metal_reflectance() const;
  Rgb facet_color(float cosine) const;
  /// f cos of the matt part for reflectance 1.
  float matt_value(const Layers& to, const Layers& from, const Vec3& o, const Vec3& i) const;
  float lost_value(const Vec3& o, const Vec3& i) const;
  float metal_loss(const Vec3& o) const;
  Lobes lobes_of(const Vec3& wo, const Layers& layers) const;
  float pdf(const Lobes& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const;
  std::optional<BsdfSample> mirrored_sample(const Vec3& wo, const Rgb& value,
                                            float probability) const;

  PrincipledParts parts_;
  InterfaceEnergy interface_;
  AnisotropicEnergy white_;  ///< of facets that reflect everything
  float plain_;              ///< share of the matt part with its facets
  Rgb metal_bend_;           ///< what metal_edge takes away (Kutz et al. 2021)
  float matt_scale_ = 0.0F;  ///< 1 / (pi mean T)
  float bare_scale_ = 0.0F;  ///< the same where no layer is (matt_scale_ unless solid)
  Rgb lost_tint_{0.0F};      ///< of light that the metal's facets throw onto each other
  float lost_scale_ = 0.0F;  ///< 1 / (pi mean loss); 0 where it stays lost
  std::optional<LayerLoss> layer_loss_;
  std::optional<LayerLight> layer_light_;
};

}  // namespace hyades::core
