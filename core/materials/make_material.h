#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/materials/material.h"
#include "core/textures/make_texture.h"

/// One maker per kind of material.
namespace hyades::core {

using MaterialPtr = std::shared_ptr<const Material>;

/// A colour or number of a material: a texture, or a value where the texture is null (the fast
/// case).
struct ColorParam {
  Rgb value{0.5F};
  TexturePtr texture;
};
struct ScalarParam {
  float value = 0.0F;
  TexturePtr texture;
};

/// Two-sided Lambert of reflectance `color` (0..1).
MaterialPtr make_lambert(const ColorParam& color);

/// Smooth dielectric of index `ior` inside, against SurfacePoint::outside_index outside;
/// `transmission` and `reflection` tint each event. Equal indices pass light unchanged.
MaterialPtr make_dielectric(float ior, const Rgb& transmission, const Rgb& reflection);

/// What becomes of light that a microfacet reflects onto another one.
enum class FacetScattering {
  single,    ///< it is lost, as in most renderers: rough metals and glass darken
  multiple,  ///< it is given back (Kulla and Conty 2017): white metal, clear glass keep everything
};

/// A dielectric with facets of GGX, alpha = roughness^2 (roughness 0: make_dielectric).
/// `scale_radiance`: refracted radiance changes by the square of the index, as physics has it; off:
/// it does not.
MaterialPtr make_rough_dielectric(float ior, const Rgb& transmission, const Rgb& reflection,
                                  const ScalarParam& roughness,
                                  FacetScattering scattering = FacetScattering::single,
                                  bool scale_radiance = true);

/// A sheet of that glass so thin that light leaves where it entered, all inner bounces summed
/// (R' = 2R / (1 + R) without absorption). Rough, it blurs alike on both sides, without loss.
MaterialPtr make_thin_dielectric(float ior, const Rgb& transmission, const Rgb& reflection,
                                 const ScalarParam& roughness = {});

/// Metal of complex index eta + i k per channel, relative to vacuum; roughness 0 is a mirror, else
/// GGX with visible-normal sampling (Heitz 2018), alpha = roughness^2.
MaterialPtr make_conductor(const Rgb& eta, const Rgb& k, const ScalarParam& roughness,
                           const Rgb& tint, FacetScattering scattering = FacetScattering::single);

/// Metal by what it looks like: `color` straight on, `edge` towards the horizon (0: darkest, 1: as
/// bright as metal gets there), which an index is found from (Gulbrandsen 2014, "Artist Friendly
/// Metallic Fresnel").
MaterialPtr make_colored_conductor(const ColorParam& color, const ColorParam& edge,
                                   const ScalarParam& roughness, const Rgb& tint,
                                   FacetScattering scattering);

/// Ideal mirror of reflectance `color`, no Fresnel.
MaterialPtr make_mirror(const ColorParam& color);

/// Atlas's glossy: (1 - reflectiveness) Lambert + reflectiveness * a lobe about the mirror
/// direction whose sharpness grows with glossiness (0..1); energy never above `color`. docs/job.md
/// has the formula.
MaterialPtr make_glossy(const ColorParam& color, const ScalarParam& reflectiveness,
                        const ScalarParam& glossiness,
                        FacetScattering scattering = FacetScattering::single);

/// (1 - amount) first + amount second.
MaterialPtr make_mix(MaterialPtr first, MaterialPtr second, const ScalarParam& amount);

MaterialPtr make_null();

/// Absorbs everything (surfaces that only emit).
MaterialPtr make_black();

/// `base`, of which only the share `opacity` (0..1) is there.
MaterialPtr make_cutout(MaterialPtr base, const ScalarParam& opacity);

/// `base` with its shading normal turned by the gradient of `height` [length] times `scale`, all of
/// the way where `strength` is 1, not at all where it is 0.
MaterialPtr make_bump(MaterialPtr base, TexturePtr height, float scale,
                      const ScalarParam& strength = {1.0F, nullptr});

/// `base` with its shading normal turned by a map in tangent space: `normals` holds x, y and z of
/// the normal as (1 + n) / 2, x along the tangent (of growing u), y up (of growing v) as OpenGL has
/// it; `strength` multiplies x and y.
MaterialPtr make_normal_map(MaterialPtr base, TexturePtr normals, const ScalarParam& strength);

/// Complex index of a metal at red, green, blue.
struct MetalIndex {
  std::string name;
  Rgb eta;
  Rgb k;
};

/// The table (sources in the file): gold, silver, copper, aluminium, ... ; nothing for other names.
std::optional<MetalIndex> find_metal(const std::string& name);
std::vector<std::string> metal_names();

}  // namespace hyades::core
