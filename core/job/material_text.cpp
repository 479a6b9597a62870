#include "core/job/resolved_parts.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/job/old_lines.h"

namespace hyades::core {
namespace {

/// From when one struct held the keys of all types.
constexpr OldLine kOldMaterialLines[] = {
    {"color", "3f000000,3f000000,3f000000"},
    {"metal", "4:gold"},
    {"eta"},
    {"k"},
    {"roughness", "00000000"},
    {"ior", "3fc00000"},
    {"transmission", kWhiteBits},
    {"reflection", kWhiteBits},
    {"reflectiveness", "3f000000"},
    {"glossiness", "3f4ccccd"},
    {"multiple_scattering", "0"},
    {"first", kNoText},
    {"second", kNoText},
    {"amount", "3f000000"},
    {"opacity", "3f800000"},
    {"sides", nullptr, "4:both"},
    {"bump.texture"},
    {"bump.height"},
    {"colored"},
    {"edge"},
    {"transmitted"},
    {"normal_map.texture"},
    {"normal_map.strength"},
    {"principled.base_color"},
    {"principled.metallic"},
    {"principled.specular"},
    {"principled.specular_tint"},
    {"principled.anisotropic"},
    {"principled.anisotropic_rotation"},
    {"principled.roughness_along"},
    {"principled.transmission"},
    {"principled.diffuse_transmission"},
    {"principled.coat"},
    {"principled.coat_roughness"},
    {"principled.coat_ior"},
    {"principled.sheen"},
    {"principled.sheen_tint"},
    {"principled.sheen_roughness"},
    {"principled.thin_walled"},
    {"principled.emission_color"},
    {"principled.emission_strength"},
    {"subsurface.color"},
    {"subsurface.radius"},
    {"subsurface.scale"},
    {"subsurface.g"},
    {"bump.strength", nullptr, "3f800000"},
};

bool has_old_line(std::string_view key) {
  return std::any_of(std::begin(kOldMaterialLines), std::end(kOldMaterialLines),
                     [&](const OldLine& line) { return key == line.key; });
}

/// The lines of `material`, by the old names.
std::vector<FieldWriter::Line> old_lines_of(FieldWriter& out, const MaterialDesc& material) {
  auto lines = lines_of(out, material);
  if (std::holds_alternative<PrincipledDesc>(material.kind)) {
    // Its roughness and ior were those of all types. multiple_scattering was no key of it, and has
    // the line of others that say nothing, whatever its default.
    std::erase(lines, FieldWriter::Line{"multiple_scattering", "1"});
    for (FieldWriter::Line& line : lines) {
      const std::string inner = "principled." + line.key;
      if (has_old_line(inner) || line.key == "multiple_scattering") line.key = inner;
    }
  }
  if (const auto* metal = std::get_if<ConductorDesc>(&material.kind)) {
    if (metal->color) {
      lines.push_back({"colored", "1"});
    } else {
      std::erase_if(lines, [](const FieldWriter::Line& line) { return line.key == "edge"; });
    }
  }
  return lines;
}

}  // namespace

void write_material(FieldWriter& out, const MaterialDesc& material) {
  write_desc(out, "material", material, kOldMaterialLines,
             [&](const MaterialDesc& desc) { return old_lines_of(out, desc); });
}

}  // namespace hyades::core
