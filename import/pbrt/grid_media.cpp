#include "import/pbrt/grid_media.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>

#include "import/pbrt/coefficients.h"
#include "import/pbrt/medium_grids.h"
#include "import/pbrt/render_sections.h"

namespace hyades::core::pbrt {
namespace {

/// Light given off, for media whose grids say where: before the grid and absorption count.
YamlPtr emission_of(Context& context, ParameterReader& reader, const MediumGrids& grids,
                    const Coefficients& c, float scale) {
  const auto has = [&](const char* name) {
    return std::any_of(grids.boxes.begin(), grids.boxes.end(),
                       [&](const VdbBox& box) { return box.name == name; });
  };
  YamlMap out;
  Rgb color(0.0F);
  if (has("temperature")) {
    // Of a uniform grid this is a grid, too.
    const bool is_number = reader.text("type") == "nanovdb";
    color = c.absorption * scale * context.exposure;
    if (is_number) color *= std::max(reader.number("Lescale", 1.0F), 0.0F);
    out.put("temperature", yaml_word("temperature"));
  } else if (reader.find("rgb", "Le") != nullptr && has("tint")) {
    color = grids.glow * scale * reader.number("Lescale", 1.0F) * context.exposure;
  } else if (const Parameter* p = reader.find("Le")) {
    // Grids of one number and none of them are factors of the whole.
    const float factor = has("glow") ? 1.0F : reader.number("Lescale", 1.0F);
    color = color_of(context, *p, ColorUse::light).value_or(Rgb(0.0F)) * factor * c.absorption *
            scale * context.exposure;
  }
  if (is_black(color)) return nullptr;
  out.put("color", color_node(color));
  if (has("glow")) out.put("grid", yaml_word("glow"));
  return out.node();
}

}  // namespace

bool is_grid_medium(const std::string& type) {
  return type == "uniformgrid" || type == "rgbgrid" || type == "cloud" || type == "nanovdb";
}

YamlPtr grid_medium_node(Context& context, size_t index, const Mat4d& body) {
  const NamedEntity& medium = context.scene.media[index];
  auto grids = medium_grids(context, medium, true);
  if (!grids) {
    context.report.errors.push_back(grids.error().message);
    return nullptr;
  }
  ParameterReader reader = read(context, medium);
  const std::string type = reader.text("type");
  const float scale = std::max(reader.number("scale", 1.0F), 0.0F);
  Coefficients c{Rgb(1.0F), Rgb(1.0F)};
  YamlMap out;
  std::string file = context.request.made + "media/" + std::to_string(index) + ".vdb";
  if (!grids->file.empty()) file = context.beside(grids->file, medium.place);
  YamlMap density{{"vdb", yaml_text(file)}, {"place", yaml_word("native")}};
  if (!grids->file.empty() && grids->grid != "density") {
    density.put("grid", yaml_text(grids->grid));
  }
  if (type == "rgbgrid") {
    // The tint says what is scattered and what absorbed.
    c = {Rgb(0.0F), Rgb(1.0F)};
    density.put("tint", yaml_word("tint"));
    context.report.note(medium.place,
                        "an rgbgrid is as dense in all channels as in the densest of them");
    if (context.scene.media[index].space != srgb_space()) {
      context.report.note(medium.place, "the colours of an rgbgrid are taken as linear sRGB");
    }
  } else {
    c.absorption = coefficient(context, reader, "sigma_a", c.absorption);
    c.scattering = coefficient(context, reader, "sigma_s", c.scattering);
  }
  out.put("absorption", color_node(c.absorption)).put("scattering", color_node(c.scattering));
  if (scale != 1.0F) out.put("scale", yaml_number(scale));
  if (const float g = reader.number("g", 0.0F); g != 0.0F) {
    out.put("g", yaml_number(std::clamp(g, -0.999F, 0.999F)));
  }
  // The body's space lies elsewhere than the medium's.
  const Mat4d placed = glm::inverse(body) * medium.to_world.at[0];
  if (YamlPtr steps = transform_node(placed)) density.put("transform", steps);
  out.put("density", density);
  if (YamlPtr emission = emission_of(context, reader, *grids, c, scale)) {
    out.put("emission", emission);
  }
  return out.node();
}

Result<Bytes> make_medium_file(const LoadedScene& loaded, const std::string& name) {
  size_t index = 0;
  const char* const end = name.data() + name.size();
  const auto [rest, wrong] = std::from_chars(name.data(), end, index);
  if (wrong != std::errc() || std::string_view(rest, static_cast<size_t>(end - rest)) != ".vdb" ||
      index >= loaded.scene.media.size()) {
    return Error{"the scene has no medium '" + name + "'"};
  }
  const SceneRequest request;
  Context context(loaded, request);
  auto grids = medium_grids(context, loaded.scene.media[index], false);
  if (!grids) return grids.error();
  return write_vdb(grids->boxes);
}

}  // namespace hyades::core::pbrt
