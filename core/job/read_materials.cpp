#include <array>

#include "core/job/kinds.h"
#include "core/job/metal_names.h"
#include "core/job/read_sections.h"
#include "core/job/read_textures.h"

namespace hyades::core {

namespace {

void read_bump(MapReader& reader, MaterialDesc& material) {
  reader.enter_section("materials.surfaces");
  if (!reader.has("bump") && !reader.listing()) {
    reader.find("bump");
    return;
  }
  BumpDesc bump;
  reader.map("bump", "materials.bump", [&](MapReader& map) {
    const char* const expected = "a texture's name or a texture";
    map.require("texture", expected);
    const YamlNode* node = map.find("texture");
    if (node != nullptr && !read_texture_input(map, "texture", *node, bump.texture)) {
      map.mismatch("texture", *node, expected);
    }
    map.animated("height", bump.height, kAnyNumber);
  });
  material.bump = bump;
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
  read_bump(reader, material);
}

void read_thin_dielectric(MapReader& reader, MaterialDesc& material) {
  reader.animated("ior", material.ior, {0.01, 100.0});
  reader.color("transmission", material.transmission, kUnitInterval);
  reader.color("reflection", material.reflection, kUnitInterval);
  read_bump(reader, material);
}

void read_dielectric(MapReader& reader, MaterialDesc& material) {
  reader.scalar_input("roughness", material.roughness, kUnitInterval);
  material.multiple_scattering = true;
  reader.flag("multiple_scattering", material.multiple_scattering);
  read_thin_dielectric(reader, material);
  read_subsurface(reader, material);
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
  reader.scalar_input("roughness", material.roughness, kUnitInterval);
  material.multiple_scattering = true;
  reader.flag("multiple_scattering", material.multiple_scattering);
  reader.color("reflection", material.reflection, kUnitInterval);
  read_bump(reader, material);
}

void read_glossy(MapReader& reader, MaterialDesc& material) {
  reader.color_input("color", material.color, kUnitInterval);
  reader.scalar_input("reflectiveness", material.reflectiveness, kUnitInterval);
  reader.scalar_input("glossiness", material.glossiness, kUnitInterval);
  reader.flag("multiple_scattering", material.multiple_scattering);
  read_bump(reader, material);
}

void read_mirror(MapReader& reader, MaterialDesc& material) {
  material.color = ColorInput{Animated<Rgb>(Rgb(1.0F)), {}};
  reader.color_input("color", material.color, kUnitInterval);
  read_bump(reader, material);
}

void read_mix(MapReader& reader, MaterialDesc& material) {
  reader.require("first", "a material's name");
  reader.require("second", "a material's name");
  reader.name_of("first", material.first, NameKind::material);
  reader.name_of("second", material.second, NameKind::material);
  reader.scalar_input("amount", material.amount, kUnitInterval);
  read_bump(reader, material);
}

void read_nothing(MapReader&, MaterialDesc&) {}

const std::array<TypeRow<MaterialDesc>, 9> kTypes = {{
    {"lambert", read_lambert},
    {"dielectric", read_dielectric},
    {"thin-dielectric", read_thin_dielectric},
    {"conductor", read_conductor},
    {"glossy", read_glossy},
    {"mirror", read_mirror},
    {"mix", read_mix},
    {"null", read_subsurface},
    {"black", read_nothing},
}};

}  // namespace

std::vector<std::string> material_types() { return type_names<MaterialDesc>(kTypes); }

void read_materials(MapReader& top) {
  read_named(top, "materials", "material", NameKind::material,
             [&](const YamlNode& node, const std::string& name, const std::string& what,
                 const std::string& path) {
               MapReader reader(top.context(), node, what, path, "materials");
               if (node.kind != YamlNode::Kind::map) return;
               MaterialDesc material;
               material.name = name;
               material.where = node.where;
               reader.find("like");
               if (!read_by_type<MaterialDesc>(reader, "type", "materials", material, kTypes)) {
                 return;
               }
               reader.finish();
               top.context().job.materials.push_back(std::move(material));
             });
}

}  // namespace hyades::core
