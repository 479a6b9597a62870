#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "core/job/read_sections.h"

namespace hyades::core {

void check_keys(MapReader& reader, ConductorDesc& metal) {
  if (metal.eta.has_value() != metal.k.has_value()) {
    reader.complain(reader.where_of(metal.eta.has_value() ? "eta" : "k"),
                    "eta and k belong together, found only one of them");
  } else if (metal.eta.has_value() && reader.has("metal")) {
    reader.complain(reader.where_of("metal"),
                    "metal and the measured eta and k are both there, expected one of them");
  }
  if (metal.eta.has_value()) metal.metal = "custom";
  if (metal.color && (reader.has("metal") || reader.has("eta"))) {
    reader.complain(reader.where_of("color"),
                    "color and a measured index are both there, expected one of them");
  } else if (!metal.color && reader.has("edge")) {
    reader.complain(reader.where_of("edge"), "edge belongs to color, which is not there");
  }
}

void check_keys(MapReader& reader, PrincipledDesc& principled) {
  if (reader.has("roughness_along") && reader.has("anisotropic")) {
    reader.complain(reader.where_of("anisotropic"),
                    "anisotropic and roughness_along are both there, expected one of them");
  }
  if (reader.has("diffuse_transmission") && !principled.thin_walled) {
    reader.complain(reader.where_of("diffuse_transmission"),
                    "diffuse_transmission is that of thin walls, expected thin_walled: true");
  }
  if (!reader.has("subsurface")) return;
  for (const char* other : {"transmission", "thin_walled"}) {
    if (!reader.has(other)) continue;
    reader.complain(reader.where_of(other),
                    std::string(other) +
                        " and a subsurface are both there, expected one of them: "
                        "with a subsurface light goes in anyway");
  }
}

void check_keys(MapReader& reader, HairDesc& /*hair*/) {
  const char* const pigment = reader.has("eumelanin") ? "eumelanin" : "pheomelanin";
  const char* first = reader.has("color") ? "color" : nullptr;
  for (const char* key : {"absorption", pigment}) {
    if (!reader.has(key)) continue;
    if (first != nullptr) {
      reader.complain(reader.where_of(key),
                      fmt::format("{} and {} are both there, expected one of color, absorption and "
                                  "pigments",
                                  first, key));
      return;
    }
    first = key;
  }
}

void read_material(MapReader& reader, const std::string& name) {
  MaterialDesc material;
  material.name = name;
  material.where = reader.where();
  if (!read_kind(reader, "materials", material)) return;
  reader.finish();
  reader.context().job.materials.push_back(std::move(material));
}

void read_materials(MapReader& top) {
  read_named(top, "materials", "material", NameKind::material,
             [](MapReader& reader, const std::string& name) {
               reader.context().materials[name] = std::make_shared<const YamlNode>(reader.node());
               read_material(reader, name);
             });
}

}  // namespace hyades::core
