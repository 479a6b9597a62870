#include <array>
#include <memory>

#include "core/job/kinds.h"
#include "core/job/metal_names.h"
#include "core/job/read_sections.h"
#include "core/job/read_textures.h"

namespace hyades::core {

namespace {

const std::array<std::string, 2> kSides = {"both", "front"};

/// Keys of all materials but null.
void read_opacity(MapReader& reader, MaterialDesc& material) {
  reader.enter_section("materials.solids");
  reader.scalar_input("opacity", material.opacity, kUnitInterval);
  reader.choice("sides", material.sides, kSides);
}

/// Keys of all materials but null and black.
void read_surface(MapReader& reader, MaterialDesc& material) {
  read_opacity(reader, material);
  reader.enter_section("materials.surfaces");
  if (reader.has("bump") || reader.listing()) {
    BumpDesc bump;
    read_texture_map(reader, "bump", "materials.bump", bump.texture,
                     [&](MapReader& map) { map.animated("height", bump.height, kAnyNumber); });
    material.bump = bump;
  } else {
    reader.find("bump");
  }
  if (reader.has("normal_map") || reader.listing()) {
    NormalMapDesc normals;
    read_texture_map(reader, "normal_map", "materials.normal_map", normals.texture,
                     [&](MapReader& map) {
                       map.scalar_input("strength", normals.strength, {0.0, 100.0});
                     });
    material.normal_map = normals;
  } else {
    reader.find("normal_map");
  }
}

void read_subsurface(MapReader& reader, MaterialDesc& material) {
  reader.enter_section("materials.subsurface");
  if (!reader.has("subsurface") && !reader.listing()) {
    reader.find("subsurface");
    return;
  }
  SubsurfaceDesc subsurface;
  reader.map("subsurface", "materials.subsurface.body", [&](MapReader& map) {
    map.require("radius", "how far light goes in it: a length, or one for each channel");
    map.color("color", subsurface.color, kUnitInterval);
    map.color("radius", subsurface.radius, kPositive);
    map.animated("scale", subsurface.scale, kPositive);
    map.animated("g", subsurface.g, {-1.0, 1.0, true, true});
  });
  material.subsurface = subsurface;
}

void read_lambert(MapReader& reader, MaterialDesc& material) {
  reader.color_input("color", material.color, kUnitInterval);
  reader.scalar_input("roughness", material.roughness, kUnitInterval);
  read_surface(reader, material);
}

void read_thin_dielectric(MapReader& reader, MaterialDesc& material) {
  reader.scalar_input("roughness", material.roughness, kUnitInterval);
  reader.animated("ior", material.ior, {0.01, 100.0});
  reader.color("transmission", material.transmission, kUnitInterval);
  reader.color("reflection", material.reflection, kUnitInterval);
  read_surface(reader, material);
}

void read_dielectric(MapReader& reader, MaterialDesc& material) {
  material.multiple_scattering = true;
  reader.flag("multiple_scattering", material.multiple_scattering);
  read_thin_dielectric(reader, material);
  read_subsurface(reader, material);
}

/// Instead of an index.
void read_metal_color(MapReader& reader, MaterialDesc& material) {
  material.colored = reader.has("color");
  reader.color_input("color", material.color, kUnitInterval);
  reader.color_input("edge", material.edge, kUnitInterval);
  if (material.colored && (reader.has("metal") || reader.has("eta"))) {
    reader.complain(reader.find("color")->where,
                    "color and a measured index are both there, expected one of them");
  } else if (!material.colored && reader.has("edge")) {
    reader.complain(reader.find("edge")->where, "edge belongs to color, which is not there");
  }
}

void read_conductor(MapReader& reader, MaterialDesc& material) {
  reader.choice("metal", material.metal, metal_names_in_jobs());
  reader.color("eta", material.eta, {0.0, 100.0, true});
  reader.color("k", material.k, {0.0, 100.0});
  if (material.eta.has_value() != material.k.has_value()) {
    const char* there = material.eta.has_value() ? "eta" : "k";
    reader.complain(reader.find(there)->where, "eta and k belong together, found only one of them");
  } else if (material.eta.has_value() && reader.has("metal")) {
    reader.complain(reader.find("metal")->where,
                    "metal and the measured eta and k are both there, expected one of them");
  }
  if (material.eta.has_value()) material.metal = "custom";
  read_metal_color(reader, material);
  reader.scalar_input("roughness", material.roughness, kUnitInterval);
  material.multiple_scattering = true;
  reader.flag("multiple_scattering", material.multiple_scattering);
  reader.color("reflection", material.reflection, kUnitInterval);
  read_surface(reader, material);
}

void read_glossy(MapReader& reader, MaterialDesc& material) {
  reader.color_input("color", material.color, kUnitInterval);
  reader.scalar_input("reflectiveness", material.reflectiveness, kUnitInterval);
  reader.scalar_input("glossiness", material.glossiness, kUnitInterval);
  reader.flag("multiple_scattering", material.multiple_scattering);
  read_surface(reader, material);
}

void read_mirror(MapReader& reader, MaterialDesc& material) {
  material.color = ColorInput{Animated<Rgb>(Rgb(1.0F)), {}};
  reader.color_input("color", material.color, kUnitInterval);
  read_surface(reader, material);
}

void read_mix(MapReader& reader, MaterialDesc& material) {
  reader.require("first", "a material's name");
  reader.require("second", "a material's name");
  reader.name_of("first", material.first, NameKind::material);
  reader.name_of("second", material.second, NameKind::material);
  reader.scalar_input("amount", material.amount, kUnitInterval);
  read_surface(reader, material);
}

void read_diffuse_transmission(MapReader& reader, MaterialDesc& material) {
  reader.color_input("color", material.color, kUnitInterval);
  reader.color_input("transmitted", material.transmitted, kUnitInterval);
  read_surface(reader, material);
}

void read_coat(MapReader& reader, MaterialDesc& material) {
  reader.require("base", "a material's name");
  reader.name_of("base", material.first, NameKind::material);
  material.color = ColorInput{Animated<Rgb>(Rgb(1.0F)), {}};
  material.amount = ScalarInput{Animated<float>(1.0F), {}};
  reader.animated("ior", material.ior, {1.0, 100.0});
  reader.scalar_input("roughness", material.roughness, kUnitInterval);
  reader.scalar_input("amount", material.amount, kUnitInterval);
  reader.color_input("color", material.color, kUnitInterval);
  read_surface(reader, material);
}

void read_sheen(MapReader& reader, MaterialDesc& material) {
  reader.name_of("base", material.first, NameKind::material);
  material.color = ColorInput{Animated<Rgb>(Rgb(1.0F)), {}};
  material.roughness = ScalarInput{Animated<float>(0.5F), {}};
  reader.color_input("color", material.color, kUnitInterval);
  reader.scalar_input("roughness", material.roughness, kUnitInterval);
  read_surface(reader, material);
}

void read_two_sided(MapReader& reader, MaterialDesc& material) {
  reader.require("front", "a material's name");
  reader.require("back", "a material's name");
  reader.name_of("front", material.first, NameKind::material);
  reader.name_of("back", material.second, NameKind::material);
  read_surface(reader, material);
}

void read_roughness_along(MapReader& reader, PrincipledDesc& p) {
  ScalarInput along{Animated<float>(0.5F), {}};
  reader.scalar_input("roughness_along", along, kUnitInterval);
  if (reader.listing() || !reader.has("roughness_along")) return;
  p.roughness_along = along;
  if (reader.has("anisotropic")) {
    reader.complain(reader.find("anisotropic")->where,
                    "anisotropic and roughness_along are both there, expected one of them");
  }
}

void read_principled(MapReader& reader, MaterialDesc& material) {
  PrincipledDesc p;
  material.roughness = ScalarInput{Animated<float>(0.5F), {}};
  reader.color_input("base_color", p.base_color, kUnitInterval);
  reader.scalar_input("metallic", p.metallic, kUnitInterval);
  reader.scalar_input("roughness", material.roughness, kUnitInterval);
  reader.animated("ior", material.ior, {1.0, 100.0});
  reader.scalar_input("specular", p.specular, kUnitInterval);
  reader.color_input("specular_tint", p.specular_tint, kUnitInterval);
  reader.scalar_input("anisotropic", p.anisotropic, kUnitInterval);
  reader.scalar_input("anisotropic_rotation", p.anisotropic_rotation, kUnitInterval);
  read_roughness_along(reader, p);
  reader.scalar_input("transmission", p.transmission, kUnitInterval);
  reader.scalar_input("coat", p.coat, kUnitInterval);
  reader.scalar_input("coat_roughness", p.coat_roughness, kUnitInterval);
  reader.animated("coat_ior", p.coat_ior, {1.0, 100.0});
  reader.scalar_input("sheen", p.sheen, kUnitInterval);
  reader.color_input("sheen_tint", p.sheen_tint, kUnitInterval);
  reader.scalar_input("sheen_roughness", p.sheen_roughness, kUnitInterval);
  reader.flag("thin_walled", p.thin_walled);
  reader.scalar_input("diffuse_transmission", p.diffuse_transmission, kUnitInterval);
  reader.color_input("emission_color", p.emission_color, {0.0});
  reader.animated("emission_strength", p.emission_strength, {0.0});
  if (reader.has("diffuse_transmission") && !p.thin_walled && !reader.listing()) {
    reader.complain(reader.find("diffuse_transmission")->where,
                    "diffuse_transmission is that of thin walls, expected thin_walled: true");
  }
  material.principled = p;
  read_surface(reader, material);
  read_subsurface(reader, material);
  if (reader.listing() || !reader.has("subsurface")) return;
  for (const char* other : {"transmission", "thin_walled"}) {
    if (!reader.has(other)) continue;
    reader.complain(reader.find(other)->where,
                    std::string(other) +
                        " and a subsurface are both there, expected one of them: "
                        "with a subsurface light goes in anyway");
  }
}

const std::array<TypeRow<MaterialDesc>, 14> kMaterialTypes = {{
    {"lambert", read_lambert},
    {"principled", read_principled},
    {"dielectric", read_dielectric},
    {"thin-dielectric", read_thin_dielectric},
    {"conductor", read_conductor},
    {"glossy", read_glossy},
    {"mirror", read_mirror},
    {"diffuse-transmission", read_diffuse_transmission},
    {"mix", read_mix},
    {"coat", read_coat},
    {"sheen", read_sheen},
    {"two-sided", read_two_sided},
    {"null", read_subsurface},
    {"black", read_opacity},
}};

}  // namespace

std::vector<std::string> material_types() { return type_names<MaterialDesc>(kMaterialTypes); }

void read_material(ReadContext& context, const YamlNode& node, const std::string& name,
                   const std::string& what, const std::string& path) {
  MapReader reader(context, node, what, path, "materials");
  if (node.kind != YamlNode::Kind::map) return;
  MaterialDesc material;
  material.name = name;
  material.where = node.where;
  reader.find("like");
  if (!read_by_type<MaterialDesc>(reader, "type", "materials", material, kMaterialTypes)) return;
  reader.finish();
  context.job.materials.push_back(std::move(material));
}

void read_materials(MapReader& top) {
  read_named(top, "materials", "material", NameKind::material,
             [&](const YamlNode& node, const std::string& name, const std::string& what,
                 const std::string& path) {
               top.context().materials[name] = std::make_shared<const YamlNode>(node);
               read_material(top.context(), node, name, what, path);
             });
}

}  // namespace hyades::core
