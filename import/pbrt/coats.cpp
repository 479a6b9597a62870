#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/materials/interface_energy.h"
#include "import/pbrt/material_kinds.h"
#include "import/pbrt/smooth_reflectance.h"

/// Coated materials. pbrt lets light walk at random between the coat's surface, its base and what
/// is in between (LayeredBxDF); jobs have a coat of clear varnish that loses nothing.
namespace hyades::core::pbrt {

CoatLayer MaterialKinds::layer(const std::string& prefix, const YamlPtr& rough) {
  CoatLayer layer;
  layer.eta = std::max(index((prefix + "eta").c_str(), 1.5F), 1.0F);
  if (rough != nullptr) {
    const float roughness = plain_number(rough).value_or(0.5F);
    layer.alpha = roughness * roughness;
  }
  layer.thickness = std::clamp(reader_.number("thickness", 0.01F), 0.0F, 100.0F);
  layer.g = std::clamp(reader_.number("g", 0.0F), -0.99F, 0.99F);
  layer.events = std::max(reader_.integer("maxdepth", 10), 1);
  reader_.integer("nsamples", 1);
  return layer;
}

YamlPtr MaterialKinds::below_coat(const YamlPtr& color, const CoatLayer& layer, const Rgb& albedo) {
  const LayerAnswer& answer = materials_.layers_.of(layer);
  // What jobs let through to the base and back of even light: all that the coat does not reflect.
  const float through = InterfaceEnergy(layer.eta).mean_rest(layer.alpha);
  const auto each = [&](const auto& value) {
    Rgb out;
    for (int c = 0; c < 3; ++c) out[c] = std::clamp(value(c) / through, 0.0F, 1.0F);
    return out;
  };
  const auto seen = [&](float r) {
    return each([&](int c) { return answer.share(r, albedo[c]); });
  };
  const auto node = [&](const Rgb& value) {
    return value.x == value.y && value.y == value.z ? yaml_number(value.x) : color_node(value);
  };
  if (const auto number = plain_number(color)) return node(seen(*number));
  if (color->kind == YamlNode::Kind::list && color->list.size() == 3) {
    Rgb base;
    for (int c = 0; c < 3; ++c) {
      base[c] = plain_number(color->list[static_cast<size_t>(c)]).value_or(0.0F);
    }
    if (albedo.x != albedo.y || albedo.y != albedo.z) {
      return color_node(each([&](int c) { return answer.share(base[c], albedo[c]); }));
    }
    // Wavelength by wavelength, for what comes back is no straight line of what the base reflects.
    Spectrum spectrum = smooth_reflectance(base);
    for (double& value : spectrum.values) {
      value = answer.share(static_cast<float>(value), albedo.x);
    }
    const Rgb seen_by_all = surface_color(spectrum);
    return color_node(each([&](int c) { return seen_by_all[c]; }));
  }
  // Of textures: n + r (a + r (b + r c)), right at 0 with its slope, at 0.5 and at 1.
  const Rgb none = each([&](int c) { return answer.scattered_only(albedo[c]); });
  const Rgb a = each([&](int c) { return answer.once(albedo[c]); });
  const Rgb rest = glm::max(seen(1.0F) - none - a, Rgb(0.0F));
  const Rgb half = seen(0.5F) - none - 0.5F * a;
  const Rgb b = glm::clamp(8.0F * half - rest, Rgb(0.0F), rest);
  const Rgb c = rest - b;
  const auto times = [&](const YamlPtr& factor) { return product(color, factor); };
  const auto plus = [&](const Rgb& term, const YamlPtr& more) {
    return YamlMap{{"type", yaml_word("add")}, {"a", node(term)}, {"b", more}}.node();
  };
  const YamlPtr sum = times(plus(a, times(plus(b, times(node(c))))));
  return none == Rgb(0.0F) ? sum : plus(none, sum);
}

YamlPtr MaterialKinds::coated_diffuse() {
  const YamlPtr rough = roughness("");
  CoatLayer layer = this->layer("", rough);
  const Rgb albedo = layer_albedo();
  layer.scatters = albedo != Rgb(0.0F);
  const YamlPtr color = textures_.color(reader_, "reflectance", Rgb(0.5F));
  const YamlPtr base =
      YamlMap{{"type", yaml_word("lambert")}, {"color", below_coat(color, layer, albedo)}}.node();
  YamlMap out{{"type", yaml_word("coat")},
              {"base", yaml_text(part("base", base))},
              {"ior", yaml_number(layer.eta)}};
  if (rough != nullptr) out.put("roughness", rough);
  put_bumps(out);
  return out.node();
}

Rgb MaterialKinds::layer_albedo() {
  const Parameter* p = reader_.find("albedo");
  if (p == nullptr) return Rgb(0.0F);
  if (p->type == "texture") {
    note("what is between a coat and its base is clear: the texture of its albedo is left out");
    return Rgb(0.0F);
  }
  if (p->type == "float" && p->numbers.size() == 1) {
    return Rgb(std::clamp(p->numbers[0], 0.0F, 1.0F));
  }
  return glm::clamp(color_of(context_, *p, ColorUse::surface).value_or(Rgb(0.0F)), Rgb(0.0F),
                    Rgb(1.0F));
}

YamlPtr MaterialKinds::coated_conductor() {
  const YamlPtr rough = roughness("interface.");
  const CoatLayer layer = this->layer("interface.", rough);
  if (layer_albedo() != Rgb(0.0F)) {
    note("what is between a coat and metal is clear: albedo and g are left out");
  }
  YamlMap base{{"type", yaml_word("conductor")}};
  put_metal(base, "conductor.", layer.eta);
  put_facets(base, "conductor.");
  YamlMap out{{"type", yaml_word("coat")},
              {"base", yaml_text(part("base", base.node()))},
              {"ior", yaml_number(layer.eta)}};
  if (rough != nullptr) out.put("roughness", rough);
  put_bumps(out);
  return out.node();
}

}  // namespace hyades::core::pbrt
