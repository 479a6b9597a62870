#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "core/job/old_lines.h"
#include "core/job/resolved_parts.h"

namespace hyades::core {
namespace {

constexpr OldLine kOldMediumLines[] = {
    {"absorption"},
    {"scattering"},
    {"albedo"},
    {"mean_free_path"},
    {"density"},
    {"phase"},
    {"g"},
    {"g2"},
    {"blend"},
    {"emission", kZeroBits},
    {"emission_strength", "3f800000"},
    {"scale"},
    {"density.vdb"},
    {"density.grid"},
    {"density.tint"},
    {"density.place"},
    {"density.step.*"},
    {"density.at"},
    {"density.noise.*"},
    {"density.shell.*"},
    {"density.march"},
    {"glow.grid"},
    {"glow.temperature"},
    {"glow.kelvin"},
    {"light_group"},
    {"index"},
};

std::vector<FieldWriter::Line> old_lines_of(FieldWriter& out, const MediumDesc& medium) {
  auto lines = lines_of(out, medium);
  const auto leave_out = [&](std::initializer_list<std::string_view> keys) {
    std::erase_if(lines, [&](const FieldWriter::Line& line) {
      return std::find(keys.begin(), keys.end(), line.key) != keys.end();
    });
  };
  if (medium.varying && medium.varying->vdb.empty()) {
    leave_out({"density.vdb", "density.grid", "density.tint", "density.place", "density.at"});
  }
  if (medium.emission && !medium.emission->has_grids()) {
    leave_out({"glow.grid", "glow.temperature", "glow.kelvin"});
  }
  return lines;
}

}  // namespace

void write_medium(FieldWriter& out, const MediumDesc& medium) {
  write_desc(out, "medium", medium, kOldMediumLines,
             [&](const MediumDesc& desc) { return old_lines_of(out, desc); });
}

}  // namespace hyades::core
