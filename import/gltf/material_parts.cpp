#include "import/gltf/material_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace hyades::core {

namespace {

using Meaning = GltfTextures::Meaning;

float number_of(const JsonValue& from, const char* key, float absent, float most = 1.0F) {
  return std::clamp(from.number(key, absent), 0.0F, most);
}

/// The index of refraction whose surface reflects this share of what comes straight on.
float index_that_reflects(float share) {
  const float root = std::sqrt(std::clamp(share, 0.0F, 0.96F));
  return (1.0F + root) / (1.0F - root);
}

}  // namespace

Rgb color_of(const JsonValue& from, const char* key, const Rgb& absent, float most) {
  Rgb color = absent;
  from.numbers(key, std::span(&color.x, 3));
  return glm::clamp(color, Rgb(0.0F), Rgb(most));
}

YamlPtr base_color_of(MaterialSheet& sheet, const Rgb& factor, const JsonValue& texture) {
  const YamlPtr plain = tinted(factor, sheet.textures.name(texture, Meaning::color, ""));
  if (!sheet.colored) return plain;
  return product(plain, YamlMap{{"type", yaml_word("vertex-color")}}.node());
}

void write_base(MaterialSheet& sheet) {
  const JsonValue pbr = sheet.value.member("pbrMetallicRoughness");
  std::array<float, 4> base = {1.0F, 1.0F, 1.0F, 1.0F};
  pbr.numbers("baseColorFactor", base);
  for (float& each : base) each = std::clamp(each, 0.0F, 1.0F);
  const JsonValue color = pbr.member("baseColorTexture");
  const JsonValue packed = pbr.member("metallicRoughnessTexture");
  sheet.out.put("base_color", base_color_of(sheet, {base[0], base[1], base[2]}, color));
  sheet.out.put("metallic", scaled(number_of(pbr, "metallicFactor", 1.0F),
                                   sheet.textures.name(packed, Meaning::data, "blue")));
  sheet.out.put("roughness", scaled(number_of(pbr, "roughnessFactor", 1.0F),
                                    sheet.textures.name(packed, Meaning::data, "green")));
  write_opacity(sheet, base[3], color);
}

void write_opacity(MaterialSheet& sheet, float alpha, const JsonValue& texture) {
  const std::string mode = sheet.value.text("alphaMode");
  if (mode.empty() || mode == "OPAQUE") return;
  if (mode != "MASK" && mode != "BLEND") {
    sheet.value.member("alphaMode").complain("is '" + mode + "', expected OPAQUE, MASK or BLEND");
    return;
  }
  const std::string name = sheet.textures.name(texture, Meaning::color, "alpha");
  YamlPtr all = scaled(alpha, name);
  if (sheet.colored) {
    const YamlMap painted{{"type", yaml_word("vertex-color")}, {"channel", yaml_word("alpha")}};
    all = product(all, painted.node());
  }
  const bool varies = sheet.colored || !name.empty();
  const float cutoff = sheet.value.number("alphaCutoff", 0.5F);
  if (mode == "BLEND") {
    if (alpha < 1.0F || varies) sheet.opacity = all;
  } else if (!varies) {
    if (alpha < cutoff) sheet.opacity = yaml_number(0.0F);
  } else {
    sheet.opacity =
        YamlMap{{"type", yaml_word("threshold")}, {"input", all}, {"level", yaml_number(cutoff)}}
            .node();
  }
}

namespace {

YamlPtr node_of(const char* type, const YamlPtr& a, const YamlPtr& b) {
  return YamlMap{{"type", yaml_word(type)}, {"a", a}, {"b", b}}.node();
}

YamlPtr remapped(const YamlPtr& input, float low, float high, float to_high) {
  YamlMap out{{"type", yaml_word("remap")}, {"input", input}};
  if (low != 0.0F) out.put("low", yaml_number(low));
  if (high != 1.0F) out.put("high", yaml_number(high));
  if (to_high != 1.0F) out.put("to_high", yaml_number(to_high));
  return out.node();
}

/// What reflects `specular` straight on and leaves the rest to the body, from place to place:
/// facets of index 1.5, which reflect 0.04, mixed with a mirror of the same hue, so that both add
/// up to the brightest channel: (1 - m) 0.04 + m = max. The body keeps 1 - m of its light, which is
/// (1 - max) / 0.96, as the extension's 1 - max is below what facets let through.
void write_textured_specular(MaterialSheet& sheet, const YamlPtr& specular) {
  constexpr float kGlass = 0.04F;
  const auto channel = [&](const char* name) {
    return YamlMap{
        {"type", yaml_word("channel")}, {"input", specular}, {"channel", yaml_word(name)}}
        .node();
  };
  const YamlPtr peak =
      node_of("max", channel("red"), node_of("max", channel("green"), channel("blue")));
  const YamlPtr hue = node_of("divide", specular, peak);
  sheet.out.put("specular", remapped(peak, 0.0F, kGlass, 0.5F)).put("specular_tint", hue);
  sheet.mirror_amount = remapped(peak, kGlass, 1.0F, 1.0F);
  sheet.mirror.put("type", yaml_word("principled"))
      .put("base_color", hue)
      .put("metallic", yaml_number(1.0F))
      .put("roughness", sheet.out.node()->find("roughness")->value);
}

}  // namespace

void write_specular_glossiness(MaterialSheet& sheet) {
  const JsonValue old = sheet.extension("KHR_materials_pbrSpecularGlossiness");
  std::array<float, 4> base = {1.0F, 1.0F, 1.0F, 1.0F};
  old.numbers("diffuseFactor", base);
  for (float& each : base) each = std::clamp(each, 0.0F, 1.0F);
  const JsonValue diffuse = old.member("diffuseTexture");
  const JsonValue packed = old.member("specularGlossinessTexture");
  sheet.out.put("base_color", base_color_of(sheet, {base[0], base[1], base[2]}, diffuse));
  // Glossiness g is roughness 1 - g.
  const float glossiness = number_of(old, "glossinessFactor", 1.0F);
  const std::string gloss = sheet.textures.name(packed, Meaning::data, "alpha");
  if (gloss.empty()) {
    sheet.out.put("roughness", yaml_number(1.0F - glossiness));
  } else {
    sheet.out.put(
        "roughness",
        YamlMap{{"type", yaml_word("invert")}, {"input", scaled(glossiness, gloss)}}.node());
  }
  const Rgb specular = color_of(old, "specularFactor", Rgb(1.0F), 1.0F);
  const std::string map = sheet.textures.name(packed, Meaning::color, "");
  if (map.empty()) {
    // The index whose facets reflect the brightest channel straight on, tinted to the colour.
    const float brightest = max_component(specular);
    sheet.out.put("ior", yaml_number(index_that_reflects(brightest)));
    sheet.out.put("specular_tint", yaml_vector(brightest > 0.0F ? specular / brightest : Rgb(0)));
  } else {
    write_textured_specular(sheet, tinted(specular, map));
  }
  write_opacity(sheet, base[3], diffuse);
}

void write_specular(MaterialSheet& sheet) {
  const JsonValue ior = sheet.extension("KHR_materials_ior");
  // 0 stands for an index without end; 1 to 100 are possible here.
  float index = ior.number("ior", 1.5F);
  index = index == 0.0F ? 100.0F : std::clamp(index, 1.0F, 100.0F);
  const JsonValue specular = sheet.extension("KHR_materials_specular");
  const Rgb color = color_of(specular, "specularColorFactor", Rgb(1.0F), 1e6F);
  // Colours above 1 make the facets reflect more than the index says: of opaque surfaces that is
  // said by another index, of clear ones `specular` gives up to twice as much.
  const float brightest = std::max(max_component(color), 1.0F);
  const bool clear =
      sheet.extension("KHR_materials_transmission").number("transmissionFactor", 0.0F) > 0.0F;
  const float more = clear ? std::min(brightest, 2.0F) : 1.0F;
  if (more < brightest && clear) {
    sheet.note("has a specularColorFactor above 2, which is held there");
  } else if (more < brightest) {
    const float root = (index - 1.0F) / (index + 1.0F);
    index = index_that_reflects(root * root * brightest);
  }
  if (index != 1.5F) sheet.out.put("ior", yaml_number(index));
  if (!specular.exists()) return;
  const std::string tint =
      sheet.textures.name(specular.member("specularColorTexture"), Meaning::color, "");
  const std::string amount =
      sheet.textures.name(specular.member("specularTexture"), Meaning::data, "alpha");
  sheet.out.put("specular",
                scaled(0.5F * more * number_of(specular, "specularFactor", 1.0F), amount));
  sheet.out.put("specular_tint", tinted(glm::min(color / brightest, Rgb(1.0F)), tint));
}

void write_anisotropy(MaterialSheet& sheet) {
  const JsonValue value = sheet.extension("KHR_materials_anisotropy");
  if (!value.exists()) return;
  const JsonValue map = value.member("anisotropyTexture");
  const std::string strength = sheet.textures.name(map, Meaning::data, "blue");
  const float factor = number_of(value, "anisotropyStrength", 0.0F);
  if (factor == 0.0F) return;
  const JsonValue pbr = sheet.value.member("pbrMetallicRoughness");
  const float roughness = number_of(pbr, "roughnessFactor", 1.0F);
  const std::string rough =
      sheet.textures.name(pbr.member("metallicRoughnessTexture"), Meaning::data, "green");
  // Along the tangent the width of facets is alpha + (1 - alpha) strength^2, with alpha =
  // roughness^2.
  const auto power = [](const YamlPtr& input, float exponent) {
    return YamlMap{
        {"type", yaml_word("power")}, {"input", input}, {"exponent", yaml_number(exponent)}}
        .node();
  };
  if (strength.empty() && rough.empty()) {
    const float alpha = roughness * roughness;
    sheet.out.put("roughness_along",
                  yaml_number(std::sqrt(alpha + (1.0F - alpha) * factor * factor)));
  } else {
    sheet.out.put("roughness_along",
                  power(YamlMap{{"type", yaml_word("mix")},
                                {"a", power(scaled(roughness, rough), 2.0F)},
                                {"b", yaml_number(1.0F)},
                                {"amount", power(scaled(factor, strength), 2.0F)}}
                            .node(),
                        0.5F));
  }
  if (!strength.empty()) {
    sheet.note("has an anisotropyTexture; only its strength (blue) is taken, not its directions");
  }
  const float turns = value.number("anisotropyRotation", 0.0F) / (2.0F * kPi);
  sheet.out.put("anisotropic_rotation", yaml_number(turns - std::floor(turns)));
}

void write_sheen(MaterialSheet& sheet) {
  const JsonValue sheen = sheet.extension("KHR_materials_sheen");
  const Rgb color = color_of(sheen, "sheenColorFactor", Rgb(0.0F), 1.0F);
  if (is_black(color)) return;
  sheet.out.put("sheen", yaml_number(1.0F));
  sheet.out.put("sheen_tint", tinted(color, sheet.textures.name(sheen.member("sheenColorTexture"),
                                                                Meaning::color, "")));
  sheet.out.put("sheen_roughness", scaled(number_of(sheen, "sheenRoughnessFactor", 0.0F),
                                          sheet.textures.name(sheen.member("sheenRoughnessTexture"),
                                                              Meaning::data, "alpha")));
}

void write_transmission(MaterialSheet& sheet) {
  const JsonValue clear = sheet.extension("KHR_materials_transmission");
  const JsonValue milky = sheet.extension("KHR_materials_diffuse_transmission");
  const float through = number_of(clear, "transmissionFactor", 0.0F);
  float matt = number_of(milky, "diffuseTransmissionFactor", 0.0F);
  if (through > 0.0F) {
    sheet.out.put("transmission",
                  scaled(through, sheet.textures.name(clear.member("transmissionTexture"),
                                                      Meaning::data, "red")));
  }
  const JsonValue volume = sheet.extension("KHR_materials_volume");
  const bool solid = volume.number("thicknessFactor", 0.0F) > 0.0F;
  if (solid && volume.has("thicknessTexture")) {
    sheet.note("has a thicknessTexture; a body is as thick as its mesh");
  }
  if (solid && matt > 0.0F) {
    sheet.note("has diffuse transmission into a volume, which is left out");
    matt = 0.0F;
  }
  if (matt > 0.0F) {
    sheet.out.put("diffuse_transmission",
                  scaled(matt, sheet.textures.name(milky.member("diffuseTransmissionTexture"),
                                                   Meaning::data, "alpha")));
    if (milky.has("diffuseTransmissionColorFactor") ||
        milky.has("diffuseTransmissionColorTexture")) {
      sheet.note("has a diffuseTransmissionColor; the base colour is taken");
    }
  }
  if (!solid && (through > 0.0F || matt > 0.0F)) sheet.out.put("thin_walled", yaml_flag(true));
}

bool lets_light_in(const MaterialSheet& sheet) {
  const auto above_zero = [&](const char* extension, const char* key) {
    return sheet.extension(extension).number(key, 0.0F) > 0.0F;
  };
  return above_zero("KHR_materials_transmission", "transmissionFactor") ||
         above_zero("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor") ||
         above_zero("KHR_materials_volume", "thicknessFactor");
}

YamlMap volume_of(const MaterialSheet& sheet) {
  const JsonValue volume = sheet.extension("KHR_materials_volume");
  const JsonValue clear = sheet.extension("KHR_materials_transmission");
  const float distance = volume.number("attenuationDistance", 0.0F);
  const Rgb color = color_of(volume, "attenuationColor", Rgb(1.0F), 1.0F);
  const bool solid = volume.number("thicknessFactor", 0.0F) > 0.0F;
  if (!solid || !(distance > 0.0F) || color == Rgb(1.0F)) return {};
  if (!(clear.number("transmissionFactor", 0.0F) > 0.0F)) return {};
  // Of light that goes `distance` far, `color` is left.
  Rgb absorption(0.0F);
  for (int i = 0; i < 3; ++i) absorption[i] = std::log(1.0F / std::max(color[i], 1e-6F)) / distance;
  return YamlMap{{"absorption", yaml_vector(absorption)}};
}

YamlPtr normal_map_of(MaterialSheet& sheet, const JsonValue& info) {
  const std::string name = sheet.textures.name(info, Meaning::data, "");
  if (name.empty()) return nullptr;
  YamlMap map{{"texture", yaml_text(name)}};
  const float scale = info.number("scale", 1.0F);
  if (scale < 0.0F) sheet.note("has a normal map of negative scale, which is left out");
  if (scale != 1.0F) map.put("strength", yaml_number(std::clamp(scale, 0.0F, 100.0F)));
  return map.node();
}

}  // namespace hyades::core
