#include "core/scene/material_makers.h"

#include "core/materials/make_layers.h"
#include "core/materials/make_matt.h"
#include "core/scene/name_table.h"
#include "core/scene/principled_maker.h"

namespace hyades::core {
namespace {

FacetScattering facets_of(const MaterialDesc& desc) {
  return desc.multiple_scattering ? FacetScattering::multiple : FacetScattering::single;
}

Result<MaterialPtr> lambert(const MaterialDesc& desc, Appearance& looks) {
  auto color = looks.color(desc.color);
  if (!color) return color.error();
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  return make_rough_matt(*color, *roughness);
}

Result<MaterialPtr> diffuse_transmission(const MaterialDesc& desc, Appearance& looks) {
  auto color = looks.color(desc.color);
  if (!color) return color.error();
  auto transmitted = looks.color(desc.transmitted);
  if (!transmitted) return transmitted.error();
  return make_diffuse_transmission(*color, *transmitted);
}

Result<MaterialPtr> mirror(const MaterialDesc& desc, Appearance& looks) {
  auto color = looks.color(desc.color);
  if (!color) return color.error();
  return make_mirror(*color);
}

Result<MaterialPtr> glossy(const MaterialDesc& desc, Appearance& looks) {
  auto base = looks.color(desc.color);
  if (!base) return base.error();
  auto reflectiveness = looks.scalar(desc.reflectiveness);
  if (!reflectiveness) return reflectiveness.error();
  auto glossiness = looks.scalar(desc.glossiness);
  if (!glossiness) return glossiness.error();
  return make_glossy(*base, *reflectiveness, *glossiness, facets_of(desc));
}

Result<MaterialPtr> dielectric(const MaterialDesc& desc, Appearance& looks) {
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  const JobTime& time = looks.time();
  return make_rough_dielectric(desc.ior.at(time), desc.transmission.at(time),
                               desc.reflection.at(time), *roughness, facets_of(desc));
}

Result<MaterialPtr> thin_dielectric(const MaterialDesc& desc, Appearance& looks) {
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  const JobTime& time = looks.time();
  return make_thin_dielectric(desc.ior.at(time), desc.transmission.at(time),
                              desc.reflection.at(time), *roughness);
}

Result<MetalIndex> index_of(const MaterialDesc& desc, const JobTime& time) {
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

Result<MaterialPtr> conductor(const MaterialDesc& desc, Appearance& looks) {
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  if (desc.colored) {
    auto color = looks.color(desc.color);
    if (!color) return color.error();
    auto edge = looks.color(desc.edge);
    if (!edge) return edge.error();
    return make_colored_conductor(*color, *edge, *roughness, desc.reflection.at(looks.time()),
                                  facets_of(desc));
  }
  const auto index = index_of(desc, looks.time());
  if (!index) return index.error();
  return make_conductor(index->eta, index->k, *roughness, desc.reflection.at(looks.time()),
                        facets_of(desc));
}

Result<MaterialPtr> mix(const MaterialDesc& desc, Appearance& looks) {
  auto first = looks.material(desc.first);
  if (!first) return first;
  auto second = looks.material(desc.second);
  if (!second) return second;
  auto amount = looks.scalar(desc.amount);
  if (!amount) return amount.error();
  return make_mix(*first, *second, *amount);
}

Result<MaterialPtr> coat(const MaterialDesc& desc, Appearance& looks) {
  auto base = looks.material(desc.first);
  if (!base) return base;
  auto amount = looks.scalar(desc.amount);
  if (!amount) return amount.error();
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  auto color = looks.color(desc.color);
  if (!color) return color.error();
  return make_coat(*base, {*amount, *roughness, *color, desc.ior.at(looks.time())});
}

Result<MaterialPtr> sheen(const MaterialDesc& desc, Appearance& looks) {
  auto base = desc.first.empty() ? Result<MaterialPtr>(make_black()) : looks.material(desc.first);
  if (!base) return base;
  auto color = looks.color(desc.color);
  if (!color) return color.error();
  auto roughness = looks.scalar(desc.roughness);
  if (!roughness) return roughness.error();
  return make_sheen(*base, *color, *roughness);
}

Result<MaterialPtr> two_sided(const MaterialDesc& desc, Appearance& looks) {
  auto front = looks.material(desc.first);
  if (!front) return front;
  auto back = looks.material(desc.second);
  if (!back) return back;
  return make_two_sided(*front, *back);
}

Result<MaterialPtr> nothing(const MaterialDesc&, Appearance&) { return make_null(); }

Result<MaterialPtr> black(const MaterialDesc&, Appearance&) { return make_black(); }

using MaterialMaker = Result<MaterialPtr> (*)(const MaterialDesc&, Appearance&);
constexpr std::array<NameRow<MaterialMaker>, 14> kMaterialMakers = {{
    {"lambert", lambert},
    {"principled", principled_material},
    {"dielectric", dielectric},
    {"thin-dielectric", thin_dielectric},
    {"conductor", conductor},
    {"glossy", glossy},
    {"mirror", mirror},
    {"diffuse-transmission", diffuse_transmission},
    {"mix", mix},
    {"coat", coat},
    {"sheen", sheen},
    {"two-sided", two_sided},
    {"null", nothing},
    {"black", black},
}};

}  // namespace

Result<MaterialPtr> make_material(const MaterialDesc& desc, Appearance& looks) {
  const auto make = look_up(kMaterialMakers, desc.type, "type of material");
  if (!make) return make.error();
  return (*make)->value(desc, looks);
}

std::vector<std::string> made_material_types() { return names_of(kMaterialMakers); }

}  // namespace hyades::core
