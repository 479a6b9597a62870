#include "import/obj/mtl_material.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "import/tinted.h"

namespace hyades::core {

namespace {

/// Colour that a mesh has of which nothing is known.
constexpr float kUsualDiffuse[3] = {0.60F, 0.45F, 0.35F};

/// How high bumps of strength 1 are, of the mesh's size: files do not say.
constexpr float kBumpShare = 0.002F;

constexpr float kUsualIndex = 1.5F;

/// Of a normal map, in the job language.
constexpr float kMostStrength = 100.0F;

/// All that may be shown; map_Ns has no counterpart.
constexpr std::pair<const char*, MtlMap MtlMaterial::*> kMaterialMaps[] = {
    {"map_Kd", &MtlMaterial::diffuse_map},        {"map_Ks", &MtlMaterial::specular_map},
    {"map_Ke", &MtlMaterial::emission_map},       {"map_d", &MtlMaterial::dissolve_map},
    {"map_bump", &MtlMaterial::bump_map},         {"norm", &MtlMaterial::normal_map},
    {"map_Pr", &MtlMaterial::roughness_map},      {"map_Pm", &MtlMaterial::metallic_map},
    {"map_Ps", &MtlMaterial::sheen_map},          {"map_Pc", &MtlMaterial::coat_map},
    {"map_Pcr", &MtlMaterial::coat_roughness_map}};

class Maker {
 public:
  Maker(const MtlMaterial& from, const MtlMesh& mesh, const PictureOf& picture)
      : from_(from), mesh_(mesh), reference_(picture) {}

  MtlLook make() {
    if (is_glass()) {
      glass();
    } else if (from_.physical()) {
      principled();
    } else if (is_metal()) {
      metal();
    } else if (has_highlights()) {
      highlights();
    } else {
      look_.material.put("type", yaml_word("lambert")).put("color", diffuse());
    }
    relief();
    if (!is_glass()) opacity();
    emission();
    left_out();
    return std::move(look_);
  }

 private:
  bool is_glass() const {
    if (from_.dissolve_map.given() || from_.diffuse_map.given()) return false;
    const int model = from_.illumination.value_or(-1);
    if (model == 4 || model == 6 || model == 7 || model == 9) return true;
    return from_.dissolve < 1.0F && from_.index.value_or(1.0F) > 1.0F;
  }

  /// Nothing is diffuse, and something is reflected.
  bool is_metal() const {
    const bool dark = from_.diffuse && is_black(*from_.diffuse) && !from_.diffuse_map.given();
    return dark && from_.specular && max_component(*from_.specular) > 0.0F;
  }

  bool has_highlights() const {
    const bool said = from_.illumination.value_or(2) >= 2;
    const bool some = from_.specular && max_component(*from_.specular) > 0.0F;
    return said && (some || from_.specular_map.given());
  }

  static float max_component(const Rgb& color) {
    return std::max(color.x, std::max(color.y, color.z));
  }

  float roughness() const {
    if (from_.roughness) return *from_.roughness;
    if (from_.exponent) return std::pow(2.0F / (*from_.exponent + 2.0F), 0.25F);
    return 0.5F;
  }

  YamlPtr diffuse() {
    if (mesh_.colored && !from_.diffuse && !from_.diffuse_map.given()) {
      return YamlMap{{"type", yaml_word("vertex-color")}}.node();
    }
    const bool known = from_.diffuse && !(from_.diffuse_map.given() && is_black(*from_.diffuse));
    const Rgb color =
        known ? *from_.diffuse : Rgb(kUsualDiffuse[0], kUsualDiffuse[1], kUsualDiffuse[2]);
    return tinted(known || !from_.diffuse_map.given() ? color : Rgb(1.0F),
                  picture(from_.diffuse_map));
  }

  void glass() {
    look_.material.put("type", yaml_word("dielectric"));
    look_.material.put("ior", yaml_number(from_.index.value_or(kUsualIndex)));
    if (from_.roughness) look_.material.put("roughness", yaml_number(*from_.roughness));
    if (from_.filter && !is_black(*from_.filter) && *from_.filter != Rgb(1.0F)) {
      look_.material.put("transmission", yaml_vector(*from_.filter));
    }
  }

  void metal() {
    look_.material.put("type", yaml_word("conductor"));
    look_.material.put("color", tinted(*from_.specular, picture(from_.specular_map)));
    const float rough = from_.exponent ? roughness() : 0.0F;
    look_.material.put("roughness", yaml_number(rough));
  }

  void highlights() {
    look_.material.put("type", yaml_word("principled"));
    look_.material.put("base_color", diffuse());
    look_.material.put("roughness", yaml_number(roughness()));
    const Rgb strength = from_.specular.value_or(Rgb(1.0F));
    const float mean = (strength.x + strength.y + strength.z) / 3.0F;
    look_.material.put("specular", scaled(mean, picture(from_.specular_map, true)));
    index();
  }

  void principled() {
    YamlMap& out = look_.material;
    out.put("type", yaml_word("principled"));
    out.put("base_color", diffuse());
    out.put("roughness", share(from_.roughness_map, from_.roughness, roughness()));
    share_if("metallic", from_.metallic_map, from_.metallic);
    share_if("sheen", from_.sheen_map, from_.sheen);
    share_if("coat", from_.coat_map, from_.coat);
    share_if("coat_roughness", from_.coat_roughness_map, from_.coat_roughness);
    if (from_.anisotropy) out.put("anisotropic", yaml_number(*from_.anisotropy));
    if (from_.rotation) {
      out.put("anisotropic_rotation", yaml_number(*from_.rotation - std::floor(*from_.rotation)));
    }
    index();
  }

  void index() {
    if (from_.index && *from_.index > 1.0F) look_.material.put("ior", yaml_number(*from_.index));
  }

  void share_if(const char* key, const MtlMap& map, const std::optional<float>& number) {
    if (map.given() || number) look_.material.put(key, share(map, number, 0.0F));
  }

  /// A number or its picture; the number multiplies the picture where it is above 0.
  YamlPtr share(const MtlMap& map, const std::optional<float>& number, float otherwise) {
    if (!map.given()) return yaml_number(number.value_or(otherwise));
    const float factor = number && *number > 0.0F ? *number : 1.0F;
    return scaled(factor, picture(map, true));
  }

  void relief() {
    if (from_.normal_map.given()) {
      YamlMap normals{{"texture", picture(from_.normal_map, true)}};
      const float strength = std::clamp(from_.normal_map.strength, 0.0F, kMostStrength);
      if (strength != 1.0F) normals.put("strength", yaml_number(strength));
      look_.material.put("normal_map", normals);
    }
    if (!from_.bump_map.given() || from_.bump_map.strength == 0.0F) return;
    const float height = from_.bump_map.strength * kBumpShare * mesh_.diagonal;
    look_.material.put("bump", YamlMap{{"texture", picture(from_.bump_map, true)},
                                       {"height", yaml_number(height)}});
  }

  void opacity() {
    if (!from_.dissolve_map.given() && from_.dissolve >= 1.0F) return;
    if (!from_.dissolve_map.given()) {
      look_.material.put("opacity", yaml_number(from_.dissolve));
      return;
    }
    const float factor = from_.dissolve > 0.0F ? from_.dissolve : 1.0F;
    look_.material.put("opacity", scaled(factor, picture(from_.dissolve_map, true)));
  }

  void emission() {
    if (is_black(from_.emission) && !from_.emission_map.given()) return;
    const Rgb color = is_black(from_.emission) ? Rgb(1.0F) : from_.emission;
    look_.emit.put("color", tinted(color, picture(from_.emission_map)));
    look_.emit.put("radiance", yaml_integer(1));
    look_.emit.put("two_sided", yaml_flag(true));
  }

  void left_out() {
    for (const std::string& line : from_.unknown) look_.notes.push_back(line + " is left out");
    const auto note = [&](const std::string& what, const char* why) {
      look_.notes.push_back(what + " of '" + from_.name + "' is left out" + why);
    };
    for (const auto& [key, map] : kMaterialMaps) {
      if ((from_.*map).given() && !used_.contains(&(from_.*map))) note(key, "");
    }
    if (from_.exponent_map.given()) note("map_Ns", ": Ns counts everywhere");
    const bool tints = from_.filter && !is_black(*from_.filter) && *from_.filter != Rgb(1.0F);
    if (tints && !is_glass()) note("Tf", ": only glass is tinted");
    if (mesh_.colored && (from_.diffuse || from_.diffuse_map.given())) {
      look_.notes.push_back("the colours of vertices are left out where '" + from_.name +
                            "' is: it has its own");
    }
  }

  /// A map's picture, null where there is none. `numbers`: what it holds are no colours.
  YamlPtr picture(const MtlMap& map, bool numbers = false) {
    if (!map.given()) return nullptr;
    used_.insert(&map);
    YamlMap out{{"type", yaml_word("image")}, {"file", yaml_text(reference_(map.file))}};
    if (numbers) out.put("color_space", yaml_word("linear"));
    if (map.clamp) out.put("wrap", yaml_word("clamp"));
    if (!map.blend) out.put("filter", yaml_word("nearest"));
    if (!map.channel.empty()) out.put("channel", yaml_word(map.channel));
    if (map.scale != Vec2(1.0F)) out.put("scale", pair(map.scale));
    if (map.offset != Vec2(0.0F)) out.put("offset", pair(map.offset));
    if (map.base == 0.0F && map.gain == 1.0F) return out.node();
    return YamlMap{{"type", yaml_word("remap")},
                   {"input", out.node()},
                   {"to_low", yaml_number(map.base)},
                   {"to_high", yaml_number(map.base + map.gain)}}
        .node();
  }

  static YamlPtr pair(const Vec2& v) { return yaml_list({yaml_number(v.x), yaml_number(v.y)}); }

  const MtlMaterial& from_;
  const MtlMesh& mesh_;
  const PictureOf& reference_;
  std::set<const MtlMap*> used_;  ///< those that the job has
  MtlLook look_;
};

}  // namespace

MtlLook look_of(const MtlMaterial& material, const MtlMesh& mesh, const PictureOf& picture) {
  return Maker(material, mesh, picture).make();
}

}  // namespace hyades::core
