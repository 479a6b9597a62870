#include "import/pbrt/media.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "import/pbrt/coefficients.h"
#include "import/pbrt/grid_media.h"

namespace hyades::core::pbrt {
namespace {

/// Light that the medium gives off where it absorbs, before absorption counts.
Rgb glow(Context& context, ParameterReader& reader) {
  const float scale = reader.number("Lescale", 1.0F);
  const Parameter* p = reader.find("Le");
  if (p == nullptr) return Rgb(0.0F);
  return color_of(context, *p, ColorUse::light).value_or(Rgb(0.0F)) * scale * context.exposure;
}

YamlPtr homogeneous(Context& context, ParameterReader& reader) {
  Coefficients c{Rgb(1.0F), Rgb(1.0F)};
  const std::string preset = reader.text("preset");
  if (!preset.empty()) {
    c = measured_coefficients(context, preset, reader.place()).value_or(c);
  } else {
    c.absorption = coefficient(context, reader, "sigma_a", c.absorption);
    c.scattering = coefficient(context, reader, "sigma_s", c.scattering);
  }
  const float scale = reader.number("scale", 1.0F);
  YamlMap out{{"absorption", color_node(c.absorption)}, {"scattering", color_node(c.scattering)}};
  if (scale != 1.0F) out.put("scale", yaml_number(std::max(scale, 0.0F)));
  if (const float g = reader.number("g", 0.0F); g != 0.0F) {
    out.put("g", yaml_number(std::clamp(g, -0.999F, 0.999F)));
  }
  const Rgb emission = glow(context, reader) * c.absorption * scale;
  if (!is_black(emission)) out.put("emission", color_node(emission));
  return out.node();
}

}  // namespace

std::string add_subsurface_medium(Context& context, ParameterReader& material, float scale, float g,
                                  const std::string& wish) {
  Coefficients c{Rgb(0.0011F, 0.0024F, 0.014F), Rgb(2.55F, 3.21F, 3.77F)};
  const std::string name = material.text("name");
  if (!name.empty()) {
    c = measured_coefficients(context, name, material.place()).value_or(c);
    g = 0.0F;
  } else {
    c.absorption = coefficient(context, material, "sigma_a", c.absorption);
    c.scattering = coefficient(context, material, "sigma_s", c.scattering);
  }
  YamlMap out{{"absorption", color_node(c.absorption * scale)},
              {"scattering", color_node(c.scattering * scale)}};
  if (g != 0.0F) out.put("g", yaml_number(std::clamp(g, -0.999F, 0.999F)));
  std::string ours = context.medium_names.add(wish);
  context.media.put(ours, out);
  return ours;
}

Media::Media(Context& context) : context_(context) {
  for (size_t i = 0; i < context.scene.media.size(); ++i) {
    by_name_[context.scene.media[i].name] = i;
  }
}

std::string Media::named(const std::string& name, const Mat4d& body, const Place& place) {
  if (name.empty()) return {};
  const auto found = by_name_.find(name);
  if (found == by_name_.end()) {
    context_.report.error(place, "there is no medium '" + name + "'");
    return {};
  }
  const NamedEntity& entity = context_.scene.media[found->second];
  ParameterReader reader = read(context_, entity);
  const std::string type = reader.text("type");
  std::string key = name;
  if (is_grid_medium(type)) {
    key.append(1, '\0').append(reinterpret_cast<const char*>(&body), sizeof(body));
  }
  const auto [known, is_new] = written_.emplace(key, std::string());
  if (!is_new) return known->second;
  YamlPtr made;
  if (type == "homogeneous") {
    made = homogeneous(context_, reader);
    reader.note_unused();
  } else if (is_grid_medium(type)) {
    made = grid_medium_node(context_, found->second, body);
  } else {
    context_.report.error(entity.place, "there is no medium of type '" + type + "'");
  }
  if (made == nullptr) return {};
  known->second = context_.medium_names.add(name);
  context_.media.put(known->second, made);
  return known->second;
}

}  // namespace hyades::core::pbrt
