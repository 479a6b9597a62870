#include "core/import/pbrt/media.h"

#include <algorithm>

#include "core/base/text.h"
#include "core/job/measured_media.h"

namespace hyades::core::pbrt {
namespace {

constexpr float kPerMillimetre = 1e-3F;

Rgb coefficient(Context& context, ParameterReader& reader, const char* name, const Rgb& otherwise) {
  const Parameter* p = reader.find(name);
  if (p == nullptr) return otherwise;
  if (p->type == "texture") {
    context.report.note(p->place, "textures of coefficients are left out");
    return otherwise;
  }
  return color_of(context, *p, ColorUse::surface).value_or(otherwise);
}

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

std::optional<Coefficients> measured_coefficients(Context& context, const std::string& name,
                                                  const Place& place) {
  const MeasuredMedium* medium = find_measured_medium(name);
  if (medium == nullptr) {
    context.report.error(place, "there is no measured medium '" + name + "'" +
                                    did_you_mean(name, measured_medium_names()));
    return std::nullopt;
  }
  // Where g was measured it is part of what scatters: what counts with g = 0 is the rest.
  const Rgb reduced = medium->scattering * (Rgb(1.0F) - medium->g);
  return Coefficients{medium->absorption * kPerMillimetre, reduced * kPerMillimetre};
}

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
  std::string ours = context.medium_names.take(wish);
  context.media.put(ours, out);
  return ours;
}

Media::Media(Context& context) : context_(context) {
  for (size_t i = 0; i < context.scene.media.size(); ++i) {
    by_name_[context.scene.media[i].name] = i;
  }
}

std::string Media::named(const std::string& name, const Place& place) {
  if (name.empty()) return {};
  const auto found = by_name_.find(name);
  if (found == by_name_.end()) {
    context_.report.error(place, "there is no medium '" + name + "'");
    return {};
  }
  const auto [known, is_new] = written_.emplace(name, std::string());
  if (!is_new) return known->second;
  const NamedEntity& entity = context_.scene.media[found->second];
  ParameterReader reader(entity.parameters, entity.place, context_.report);
  const std::string type = reader.text("type");
  YamlPtr made;
  if (type == "homogeneous") {
    made = homogeneous(context_, reader);
  } else {
    context_.report.error(entity.place, "there is no medium of type '" + type + "'");
    return {};
  }
  reader.note_unused();
  known->second = context_.medium_names.take(name);
  context_.media.put(known->second, made);
  return known->second;
}

}  // namespace hyades::core::pbrt
