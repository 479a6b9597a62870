#include "import/pbrt/material_kinds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/materials/make_material.h"
#include "import/pbrt/media.h"

namespace hyades::core::pbrt {
namespace {

/// Below it facets are as good as a mirror (in pbrt, too).
constexpr float kSmoothAlpha = 1e-3F;

}  // namespace

MaterialKinds::MaterialKinds(Materials& materials, Context& context, Textures& textures,
                             const Entity& entity, std::string wish, bool strands)
    : materials_(materials),
      context_(context),
      textures_(textures),
      entity_(entity),
      wish_(std::move(wish)),
      strands_(strands),
      reader_(entity.parameters, entity.place, context.report) {}

void MaterialKinds::note(const std::string& what) { context_.report.note(entity_.place, what); }

MadeMaterial MaterialKinds::make(const std::string& type) {
  using Maker = YamlPtr (MaterialKinds::*)();
  struct Row {
    const char* name;
    Maker maker;
  };
  using M = MaterialKinds;
  static const std::vector<Row> rows = {
      {"coatedconductor", &M::coated_conductor},
      {"coateddiffuse", &M::coated_diffuse},
      {"conductor", &M::conductor},
      {"dielectric", &M::dielectric},
      {"diffuse", &M::diffuse},
      {"diffusetransmission", &M::diffuse_transmission},
      {"hair", &M::hair},
      {"interface", &M::interface},
      {"measured", &M::measured},
      {"mix", &M::mix},
      {"subsurface", &M::subsurface},
      {"thindielectric", &M::thin_dielectric},
  };
  MadeMaterial out;
  reader_.text("type");
  remap_ = reader_.flag("remaproughness", true);
  if (type.empty() || type == "none" || type == "interface") {
    out.is_interface = true;
    out.node = interface();
    reader_.note_unused();
    return out;
  }
  std::vector<std::string> names;
  for (const Row& row : rows) {
    names.emplace_back(row.name);
    if (type != row.name) continue;
    out.node = (this->*row.maker)();
    out.interior = interior_;
    reader_.note_unused();
    return out;
  }
  context_.report.error(entity_.place,
                        "there is no material '" + type + "'" + did_you_mean(type, names));
  return out;
}

float MaterialKinds::index(const char* name, float otherwise) {
  const Parameter* p = reader_.find(name);
  if (p == nullptr) return otherwise;
  if (p->type == "float" && p->numbers.size() == 1) {
    // As jobs have it.
    if (p->numbers[0] >= 0.01F && p->numbers[0] <= 100.0F) return p->numbers[0];
    context_.report.error(p->place, "an index of refraction lies between 0.01 and 100");
    return otherwise;
  }
  const auto color = color_of(context_, *p, ColorUse::surface);
  if (!color) return otherwise;
  note("light is refracted alike in all colours: the index of refraction is a mean");
  return luminance(*color);
}

YamlPtr MaterialKinds::roughness(const std::string& prefix) {
  // Our alpha is the square of roughness; pbrt's is its root, or itself where it is not remapped.
  const float exponent = remap_ ? 0.25F : 0.5F;
  YamlPtr both = textures_.number(reader_, (prefix + "roughness").c_str(), 0.0F);
  YamlPtr u = textures_.number_if(reader_, (prefix + "uroughness").c_str());
  YamlPtr v = textures_.number_if(reader_, (prefix + "vroughness").c_str());
  if (u == nullptr) u = both;
  if (v == nullptr) v = both;
  const auto u_number = plain_number(u);
  const auto v_number = plain_number(v);
  if (u_number && v_number) {
    const float alpha_u = remap_ ? std::sqrt(std::max(*u_number, 0.0F)) : *u_number;
    const float alpha_v = remap_ ? std::sqrt(std::max(*v_number, 0.0F)) : *v_number;
    if (std::max(alpha_u, alpha_v) < kSmoothAlpha) return nullptr;
    if (alpha_u != alpha_v) note("highlights are as wide in u as in v: the mean of both");
    const float alpha = std::sqrt(std::max(alpha_u, 1e-4F) * std::max(alpha_v, 1e-4F));
    return yaml_number(std::min(std::sqrt(alpha), 1.0F));
  }
  if (u->scalar != v->scalar) note("highlights are as wide in v as in u");
  return YamlMap{{"type", yaml_word("power")},
                 {"input", u_number ? v : u},
                 {"exponent", yaml_number(exponent)}}
      .node();
}

void MaterialKinds::put_facets(YamlMap& out, const std::string& prefix) {
  const YamlPtr rough = roughness(prefix);
  if (rough == nullptr) return;
  // pbrt's facets lose the light that they throw onto each other.
  out.put("roughness", rough).put("multiple_scattering", yaml_flag(false));
}

void MaterialKinds::put_bumps(YamlMap& out) {
  if (const Parameter* p = reader_.find("texture", "displacement")) {
    const Textures::Height height = textures_.height(p->texts[0], p->place);
    if (height.texture != nullptr) {
      out.put("bump", YamlMap{{"texture", height.texture}, {"height", yaml_number(height.factor)}});
    }
  } else {
    reader_.number_if("displacement");  // everywhere the same: nothing to see
  }
  const std::string map = reader_.text("normalmap");
  if (map.empty()) return;
  const std::string file = context_.beside(map, entity_.place);
  if (file.empty()) return;
  const YamlPtr image = YamlMap{
      {"type", yaml_word("image")},
      {"file", yaml_text(file)},
      {"color_space",
       yaml_word("linear")}}.node();
  out.put("normal_map", YamlMap{{"texture", image}});
}

std::string MaterialKinds::part(const char* name, const YamlPtr& node) {
  std::string ours = context_.material_names.add(wish_ + "." + name);
  context_.materials.put(ours, node);
  return ours;
}

YamlPtr MaterialKinds::interface() { return YamlMap{{"type", yaml_word("null")}}.node(); }

YamlPtr MaterialKinds::diffuse() {
  YamlMap out{{"type", yaml_word("lambert")},
              {"color", textures_.color(reader_, "reflectance", Rgb(0.5F))}};
  put_bumps(out);
  return out.node();
}

YamlPtr MaterialKinds::diffuse_transmission() {
  const float scale = reader_.number("scale", 1.0F);
  const auto scaled = [&](const char* name) {
    YamlPtr color = textures_.color(reader_, name, Rgb(0.25F));
    if (scale == 1.0F) return color;
    return product(color, yaml_number(scale));
  };
  YamlMap out{{"type", yaml_word("diffuse-transmission")},
              {"color", scaled("reflectance")},
              {"transmitted", scaled("transmittance")}};
  put_bumps(out);
  return out.node();
}

YamlPtr MaterialKinds::dielectric() {
  YamlMap out{{"type", yaml_word("dielectric")}, {"ior", yaml_number(index("eta", 1.5F))}};
  put_facets(out, "");
  put_bumps(out);
  return out.node();
}

YamlPtr MaterialKinds::thin_dielectric() {
  YamlMap out{{"type", yaml_word("thin-dielectric")}, {"ior", yaml_number(index("eta", 1.5F))}};
  put_bumps(out);
  return out.node();
}

void MaterialKinds::put_metal(YamlMap& out, const std::string& prefix, float around) {
  const Parameter* reflectance = reader_.find("reflectance");
  if (reflectance != nullptr) {
    if (reflectance->type == "texture") {
      // An index of 1 and what absorption makes of it is near the middle of what `edge` can say.
      out.put("color", textures_.color(reader_, "reflectance", Rgb(0.5F)));
      out.put("edge", yaml_number(0.9F));
      return;
    }
    const auto color = color_of(context_, *reflectance, ColorUse::surface);
    if (!color) return;
    const Rgb r = glm::clamp(*color, Rgb(0.0F), Rgb(0.9999F));
    const Rgb k = 2.0F * glm::sqrt(r) / glm::sqrt(Rgb(1.0F) - r);
    out.put("eta", color_node(Rgb(1.0F / around))).put("k", color_node(k / around));
    return;
  }
  const auto name_of = [&](const char* what, const char* otherwise) {
    const Parameter* p = reader_.find((prefix + what).c_str());
    if (p == nullptr) return std::string(otherwise);
    return p->type == "spectrum" && !p->texts.empty() ? p->texts[0] : std::string();
  };
  const auto eta_name = named_metal(name_of("eta", "metal-Cu-eta"));
  const auto k_name = named_metal(name_of("k", "metal-Cu-k"));
  const bool known = eta_name && k_name && eta_name->formula == k_name->formula &&
                     !eta_name->is_k && k_name->is_k && !eta_name->metal.empty();
  if (known && around == 1.0F) {
    out.put("metal", yaml_word(std::string(eta_name->metal)));
    return;
  }
  const auto value_of = [&](const char* what, const auto& metal) {
    if (metal && !metal->metal.empty()) {
      const auto measured = find_metal(std::string(metal->metal));
      if (measured) return metal->is_k ? Rgb(measured->k) : Rgb(measured->eta);
    }
    if (metal) return metal->is_k ? metal->k : metal->eta;
    const Parameter* p = reader_.find((prefix + what).c_str());
    if (p == nullptr) return Rgb(1.0F);
    if (p->type == "texture") {
      note("a conductor's " + std::string(what) + " is the same everywhere: that of copper");
      const auto copper = find_metal("copper");
      return copper ? (what[0] == 'k' ? Rgb(copper->k) : Rgb(copper->eta)) : Rgb(1.0F);
    }
    return color_of(context_, *p, ColorUse::surface).value_or(Rgb(1.0F));
  };
  const Rgb eta = glm::clamp(value_of("eta", eta_name) / around, Rgb(1e-3F), Rgb(100.0F));
  const Rgb k = glm::clamp(value_of("k", k_name) / around, Rgb(0.0F), Rgb(100.0F));
  out.put("eta", color_node(eta)).put("k", color_node(k));
}

YamlPtr MaterialKinds::conductor() {
  YamlMap out{{"type", yaml_word("conductor")}};
  put_metal(out, "", 1.0F);
  put_facets(out, "");
  put_bumps(out);
  return out.node();
}

YamlPtr MaterialKinds::mix() {
  const auto names = reader_.texts("materials");
  if (names.size() != 2) {
    context_.report.error(entity_.place, "a mixture needs \"string materials\" with two names");
    return nullptr;
  }
  YamlMap out{{"type", yaml_word("mix")}};
  for (size_t i = 0; i < 2; ++i) {
    ShapeEntity user;
    user.place = entity_.place;
    user.material_name = names[i];
    const WrittenMaterial part = materials_.of(user);
    if (part.name.empty()) return nullptr;
    out.put(i == 0 ? "first" : "second", yaml_text(part.name));
  }
  out.put("amount", textures_.number(reader_, "amount", 0.5F));
  return out.node();
}

YamlPtr MaterialKinds::subsurface() {
  YamlMap out{{"type", yaml_word("dielectric")}, {"ior", yaml_number(index("eta", 1.33F))}};
  put_facets(out, "");
  const float scale = reader_.number("scale", 1.0F);
  const float g = reader_.number("g", 0.0F);
  if (reader_.find("reflectance") != nullptr && reader_.find("name") == nullptr &&
      reader_.find("sigma_a") == nullptr) {
    const auto constant = [&](const char* name, const Rgb& otherwise) {
      const Parameter* p = reader_.find(name);
      if (p == nullptr) return otherwise;
      if (p->type == "texture") {
        note("the " + std::string(name) + " of a body is the same everywhere: grey of 0.5 or 1");
        return otherwise;
      }
      return color_of(context_, *p, ColorUse::surface).value_or(otherwise);
    };
    const Rgb color = glm::min(constant("reflectance", Rgb(0.5F)), Rgb(1.0F));
    const Rgb radius = constant("mfp", Rgb(1.0F)) * scale;
    YamlMap body{{"color", color_node(color)}, {"radius", color_node(glm::max(radius, 1e-9F))}};
    if (g != 0.0F) body.put("g", yaml_number(std::clamp(g, -0.99F, 0.99F)));
    out.put("subsurface", body);
  } else {
    interior_ = add_subsurface_medium(context_, reader_, scale, g, wish_);
  }
  put_bumps(out);
  return out.node();
}

YamlPtr MaterialKinds::hair() {
  if (!strands_) return hair_on_surface();
  YamlMap out{{"type", yaml_word("hair")}};
  YamlPtr color = textures_.color_if(reader_, "reflectance");
  if (color == nullptr) color = textures_.color_if(reader_, "color");
  const float eumelanin = reader_.number("eumelanin", 0.0F);
  const float pheomelanin = reader_.number("pheomelanin", 0.0F);
  const Parameter* p = reader_.find("sigma_a");
  if (p != nullptr && p->type == "texture") note("a texture of sigma_a is left out");
  const auto absorption = p != nullptr && p->type != "texture"
                              ? color_of(context_, *p, ColorUse::surface)
                              : std::nullopt;
  if (absorption) {
    out.put("absorption", color_node(glm::max(*absorption, Rgb(0.0F))));
  } else if (color != nullptr) {
    out.put("color", color);
  } else if (eumelanin > 0.0F || pheomelanin > 0.0F) {
    out.put("eumelanin", yaml_number(std::max(eumelanin, 0.0F)))
        .put("pheomelanin", yaml_number(std::max(pheomelanin, 0.0F)));
  }
  const std::pair<const char*, const char*> widths[] = {{"beta_m", "roughness"},
                                                        {"beta_n", "radial_roughness"}};
  for (const auto& [theirs, ours] : widths) {
    if (const YamlPtr width = textures_.number_if(reader_, theirs)) out.put(ours, width);
  }
  out.put("ior", yaml_number(std::clamp(reader_.number("eta", 1.55F), 1.0F, 100.0F)));
  // pbrt turns them the other way.
  out.put("tilt", yaml_number(std::clamp(-reader_.number("alpha", 2.0F), -45.0F, 45.0F)));
  return out.node();
}

YamlPtr MaterialKinds::hair_on_surface() {
  note(
      "hair on what is no curve is a rough matt surface with a highlight: its fibres do not "
      "scatter light as hair does");
  YamlPtr color = textures_.color_if(reader_, "reflectance");
  if (color == nullptr) color = textures_.color_if(reader_, "color");
  for (const char* name : {"eta", "beta_m", "beta_n", "alpha"}) reader_.find(name);
  if (color == nullptr) {
    // What pigments absorb (d'Eon et al. 2011), and how hair that absorbs looks (Chiang et al.
    // 2016, equation 9, for a roughness of 0.3).
    const float eumelanin = reader_.number("eumelanin", 0.0F);
    const float pheomelanin = reader_.number("pheomelanin", 0.0F);
    Rgb absorption =
        eumelanin * Rgb(0.419F, 0.697F, 1.37F) + pheomelanin * Rgb(0.187F, 0.4F, 1.05F);
    const Parameter* p = reader_.find("sigma_a");
    if (p != nullptr && p->type != "texture") {
      absorption = color_of(context_, *p, ColorUse::surface).value_or(absorption);
    } else if (is_black(absorption)) {
      absorption = 1.3F * Rgb(0.419F, 0.697F, 1.37F);
    }
    const Rgb depth = -5.84F * glm::sqrt(absorption);
    color = color_node({std::exp(depth.x), std::exp(depth.y), std::exp(depth.z)});
  }
  return YamlMap{
      {"type", yaml_word("principled")}, {"base_color", color}, {"roughness", yaml_number(0.5F)}}
      .node();
}

YamlPtr MaterialKinds::measured() {
  note("a measured BSDF is not read: a grey glossy surface stands in");
  reader_.text("filename");
  YamlMap out{{"type", yaml_word("glossy")}};
  put_bumps(out);
  return out.node();
}

}  // namespace hyades::core::pbrt
