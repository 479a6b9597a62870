#include "core/scene/material_makers.h"

#include <variant>

#include "core/materials/make_hair.h"
#include "core/materials/make_layers.h"
#include "core/materials/make_matt.h"
#include "core/materials/make_principled.h"

namespace hyades::core {
namespace {

FacetScattering facets_of(bool multiple_scattering) {
  return multiple_scattering ? FacetScattering::multiple : FacetScattering::single;
}

Result<MaterialPtr> make(const LambertDesc& desc, Appearance& looks) {
  auto color = looks.color(desc.color);
  if (!color) return color.error();
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  return make_rough_matt(*color, *roughness);
}

Result<MaterialPtr> make(const PrincipledDesc& p, Appearance& looks) {
  PrincipledParams params;
  struct Color {
    const ColorInput& from;
    ColorParam& to;
  };
  for (const Color& each :
       {Color{p.base_color, params.base_color}, Color{p.specular_tint, params.specular_tint},
        Color{p.sheen_tint, params.sheen_tint}}) {
    auto made = looks.color(each.from);
    if (!made) return made.error();
    each.to = *made;
  }
  struct Number {
    const ScalarInput& from;
    ScalarParam& to;
  };
  for (const Number& each :
       {Number{p.metallic, params.metallic}, Number{p.roughness, params.roughness},
        Number{p.specular, params.specular}, Number{p.anisotropic, params.anisotropic},
        Number{p.anisotropic_rotation, params.anisotropic_rotation},
        Number{p.transmission, params.transmission},
        Number{p.diffuse_transmission, params.diffuse_transmission}, Number{p.coat, params.coat},
        Number{p.coat_roughness, params.coat_roughness}, Number{p.sheen, params.sheen},
        Number{p.sheen_roughness, params.sheen_roughness}}) {
    auto made = looks.scalar(each.from);
    if (!made) return made.error();
    each.to = *made;
  }
  if (p.roughness_along) {
    auto along = looks.scalar(*p.roughness_along);
    if (!along) return along.error();
    params.roughness_along = *along;
  }
  params.ior = p.ior.at(looks.time());
  params.coat_ior = p.coat_ior.at(looks.time());
  params.thin_walled = p.thin_walled;
  params.facets = facets_of(p.multiple_scattering);
  params.scale_radiance = p.scale_radiance;
  params.subsurface = p.subsurface.has_value();
  return make_principled(params);
}

Result<MaterialPtr> make(const DielectricDesc& desc, Appearance& looks) {
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  const JobTime& time = looks.time();
  return make_rough_dielectric(desc.ior.at(time), desc.transmission.at(time),
                               desc.reflection.at(time), *roughness,
                               facets_of(desc.multiple_scattering), desc.scale_radiance);
}

Result<MaterialPtr> make(const ThinDielectricDesc& desc, Appearance& looks) {
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  const JobTime& time = looks.time();
  return make_thin_dielectric(desc.ior.at(time), desc.transmission.at(time),
                              desc.reflection.at(time), *roughness);
}

Result<MetalIndex> index_of(const ConductorDesc& desc, const JobTime& time) {
  if (desc.eta && desc.k) {
    MetalIndex index;
    index.eta = desc.eta->at(time);
    index.k = desc.k->at(time);
    return index;
  }
  const auto found = find_metal(desc.metal);
  if (!found) return Error{"there is no metal '" + desc.metal + "' in the table"};
  return *found;
}

Result<MaterialPtr> make(const ConductorDesc& desc, Appearance& looks) {
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  const Rgb reflection = desc.reflection.at(looks.time());
  const FacetScattering facets = facets_of(desc.multiple_scattering);
  if (desc.color) {
    auto color = looks.color(*desc.color);
    if (!color) return color.error();
    auto edge = looks.color(desc.edge);
    if (!edge) return edge.error();
    return make_colored_conductor(*color, *edge, *roughness, reflection, facets);
  }
  const auto index = index_of(desc, looks.time());
  if (!index) return index.error();
  return make_conductor(index->eta, index->k, *roughness, reflection, facets);
}

Result<MaterialPtr> make(const GlossyDesc& desc, Appearance& looks) {
  auto base = looks.color(desc.color);
  if (!base) return base.error();
  auto reflectiveness = looks.scalar(desc.reflectiveness);
  if (!reflectiveness) return reflectiveness.error();
  auto glossiness = looks.scalar(desc.glossiness);
  if (!glossiness) return glossiness.error();
  return make_glossy(*base, *reflectiveness, *glossiness, facets_of(desc.multiple_scattering));
}

Result<MaterialPtr> make(const MirrorDesc& desc, Appearance& looks) {
  auto color = looks.color(desc.color);
  if (!color) return color.error();
  return make_mirror(*color);
}

Result<MaterialPtr> make(const DiffuseTransmissionDesc& desc, Appearance& looks) {
  auto color = looks.color(desc.color);
  if (!color) return color.error();
  auto transmitted = looks.color(desc.transmitted);
  if (!transmitted) return transmitted.error();
  return make_diffuse_transmission(*color, *transmitted);
}

Result<MaterialPtr> make(const MixDesc& desc, Appearance& looks) {
  auto first = looks.material(desc.first);
  if (!first) return first;
  auto second = looks.material(desc.second);
  if (!second) return second;
  auto amount = looks.scalar(desc.amount);
  if (!amount) return amount.error();
  return make_mix(*first, *second, *amount);
}

Result<MaterialPtr> make(const CoatDesc& desc, Appearance& looks) {
  auto base = looks.material(desc.base);
  if (!base) return base;
  auto amount = looks.scalar(desc.amount);
  if (!amount) return amount.error();
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  auto color = looks.color(desc.color);
  if (!color) return color.error();
  return make_coat(*base, {*amount, *roughness, *color, desc.ior.at(looks.time())});
}

Result<MaterialPtr> make(const SheenDesc& desc, Appearance& looks) {
  auto base = desc.base.empty() ? Result<MaterialPtr>(make_black()) : looks.material(desc.base);
  if (!base) return base;
  auto color = looks.color(desc.color);
  if (!color) return color.error();
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  return make_sheen(*base, *color, *roughness);
}

Result<MaterialPtr> make(const TwoSidedDesc& desc, Appearance& looks) {
  auto front = looks.material(desc.front);
  if (!front) return front;
  auto back = looks.material(desc.back);
  if (!back) return back;
  return make_two_sided(*front, *back);
}

Result<MaterialPtr> make(const HairDesc& desc, Appearance& looks) {
  const JobTime& time = looks.time();
  HairParams params;
  if (desc.color) {
    auto color = looks.color(*desc.color);
    if (!color) return color.error();
    params.color = *color;
  }
  params.absorption = desc.absorption
                          ? desc.absorption->at(time)
                          : melanin_absorption(desc.eumelanin.at(time), desc.pheomelanin.at(time));
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  params.roughness = *roughness;
  auto radial_roughness = looks.scalar(desc.radial_roughness);
  if (!radial_roughness) return radial_roughness.error();
  params.radial_roughness = *radial_roughness;
  params.ior = desc.ior.at(time);
  params.tilt = desc.tilt.at(time);
  return make_hair(params);
}

Result<MaterialPtr> make(const NullDesc&, Appearance&) { return make_null(); }

Result<MaterialPtr> make(const BlackDesc&, Appearance&) { return make_black(); }

}  // namespace

Result<MaterialPtr> make_material(const MaterialDesc& desc, Appearance& looks) {
  return std::visit([&](const auto& kind) { return make(kind, looks); }, desc.kind);
}

}  // namespace hyades::core
