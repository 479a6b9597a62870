#include "import/gltf/materials.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "import/gltf/material_parts.h"

namespace hyades::core {

namespace {

using Meaning = GltfTextures::Meaning;

/// Light that a surface gives off: its colour and how much.
struct Glow {
  YamlPtr color;
  float strength = 0.0F;
};

Glow glow_of(MaterialSheet& sheet) {
  Rgb color = color_of(sheet.value, "emissiveFactor", Rgb(0.0F), 1e9F);
  if (is_black(color)) return {};
  Glow glow;
  glow.strength = sheet.extension("KHR_materials_emissive_strength")
                      .number("emissiveStrength", 1.0F, 0.0F, 1e9F);
  glow.color =
      tinted(color, sheet.textures.name(sheet.value.member("emissiveTexture"), Meaning::color, ""));
  return glow;
}

/// Its colour whatever light falls on it: the colour is given off.
Glow unlit_of(MaterialSheet& sheet) {
  const JsonValue pbr = sheet.value.member("pbrMetallicRoughness");
  std::array<float, 4> base = {1.0F, 1.0F, 1.0F, 1.0F};
  pbr.numbers("baseColorFactor", base);
  const JsonValue texture = pbr.member("baseColorTexture");
  write_opacity(sheet, base[3], texture);
  return {base_color_of(sheet, {base[0], base[1], base[2]}, texture), 1.0F};
}

/// Whether two textureInfos mean the same.
bool same(const JsonValue& a, const JsonValue& b) {
  if (!a.exists() || !b.exists()) return a.exists() == b.exists();
  return *a.raw() == *b.raw();
}

}  // namespace

GltfMaterials::GltfMaterials(const GltfModel& model, const SceneRequest& request,
                             GltfTextures& textures, std::vector<std::string>& notes)
    : model_(model),
      textures_(textures),
      notes_(notes),
      values_(model.root(trouble_).list("materials")),
      names_("material", request.prefix) {}

const GltfMaterial& GltfMaterials::get(int index, bool colored) {
  static const nlohmann::json kDefault = nlohmann::json::object();
  const auto known = made_.find({index, colored});
  if (known != made_.end()) return known->second;
  GltfMaterial& out = made_[{index, colored}];
  const JsonValue value = index < 0 ? JsonValue(&kDefault, "the default material", trouble_)
                                    : values_[static_cast<size_t>(index)];
  // The same material of plain and of coloured meshes are two.
  const bool second = made_.count({index, !colored}) != 0;
  const std::string wanted = index < 0 ? "default" : value.text("name");
  out.name = names_.add(wanted + (second && !wanted.empty() ? ".colored" : ""));
  write(value, colored, out);
  return out;
}

void GltfMaterials::write(const JsonValue& value, bool colored, GltfMaterial& out) {
  MaterialSheet sheet{value, textures_, notes_};
  sheet.colored = colored;
  const JsonValue extensions = value.member("extensions");
  Glow glow;
  const bool both_sides = value.flag("doubleSided", false);
  if (extensions.has("KHR_materials_unlit")) {
    sheet.out.put("type", yaml_word("black"));
    glow = unlit_of(sheet);
    out.shines = true;
    sheet.note("is unlit: it gives off its colour, and lights what is around it");
    YamlMap emit{{"color", glow.color}, {"radiance", yaml_number(glow.strength)}};
    if (both_sides) emit.put("two_sided", yaml_flag(true));
    out.emit = emit.node();
    if (!both_sides) sheet.out.put("sides", yaml_word("front"));
    if (sheet.opacity) sheet.out.put("opacity", sheet.opacity);
    materials_.put(out.name, sheet.out);
    return;
  }
  sheet.out.put("type", yaml_word("principled"));
  if (extensions.has("KHR_materials_pbrSpecularGlossiness")) {
    write_specular_glossiness(sheet);
  } else {
    write_base(sheet);
    write_specular(sheet);
  }
  write_anisotropy(sheet);
  write_sheen(sheet);
  write_transmission(sheet);
  const YamlMap medium = volume_of(sheet);
  if (!medium.empty()) {
    out.interior = out.name;
    media_.put(out.interior, medium);
  }
  const JsonValue coat = sheet.extension("KHR_materials_clearcoat");
  const float coated = std::clamp(coat.number("clearcoatFactor", 0.0F), 0.0F, 1.0F);
  const JsonValue bumps = value.member("normalTexture");
  const JsonValue coat_bumps = coat.member("clearcoatNormalTexture");
  // The coat has a normal map of its own, or none: where that is not the base's, it has to be a
  // layer by itself.
  const bool mixed = !sheet.mirror.empty();
  const bool apart = coated > 0.0F && (mixed || !same(bumps, coat_bumps));
  if (const YamlPtr normals = normal_map_of(sheet, bumps)) {
    sheet.out.put("normal_map", normals);
    if (mixed) sheet.mirror.put("normal_map", normals);
  }
  const auto coat_amount = [&] {
    return scaled(coated, textures_.name(coat.member("clearcoatTexture"), Meaning::data, "red"));
  };
  const auto coat_roughness = [&] {
    return scaled(std::clamp(coat.number("clearcoatRoughnessFactor", 0.0F), 0.0F, 1.0F),
                  textures_.name(coat.member("clearcoatRoughnessTexture"), Meaning::data, "green"));
  };
  if (coated > 0.0F && !apart) {
    sheet.out.put("coat", coat_amount()).put("coat_roughness", coat_roughness());
  }
  glow = glow_of(sheet);
  out.shines = glow.strength > 0.0F;
  if (glow.strength > 0.0F && (both_sides || apart || mixed)) {
    YamlMap emit{{"color", glow.color}, {"radiance", yaml_number(glow.strength)}};
    if (both_sides) emit.put("two_sided", yaml_flag(true));
    out.emit = emit.node();
  } else if (glow.strength > 0.0F) {
    sheet.out.put("emission_color", glow.color);
    sheet.out.put("emission_strength", yaml_number(glow.strength));
  }
  const std::string called = value.text("name");
  const auto part = [&](const char* what) {
    return names_.add(called.empty() ? what : called + "." + what);
  };
  YamlMap whole = sheet.out;
  if (mixed) {
    const std::string body = part("body");
    const std::string mirror = part("mirror");
    materials_.put(body, sheet.out).put(mirror, sheet.mirror);
    whole = YamlMap{{"type", yaml_word("mix")},
                    {"first", yaml_text(body)},
                    {"second", yaml_text(mirror)},
                    {"amount", sheet.mirror_amount}};
  }
  if (apart) {
    const std::string base = part("base");
    materials_.put(base, whole);
    whole = YamlMap{{"type", yaml_word("coat")}, {"base", yaml_text(base)}};
    whole.put("amount", coat_amount()).put("roughness", coat_roughness());
    if (const YamlPtr normals = normal_map_of(sheet, coat_bumps)) whole.put("normal_map", normals);
  }
  if (!both_sides && !lets_light_in(sheet)) whole.put("sides", yaml_word("front"));
  if (sheet.opacity) whole.put("opacity", sheet.opacity);
  materials_.put(out.name, whole);
}

}  // namespace hyades::core
