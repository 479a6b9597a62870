#include "cli/media_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/color.h"

namespace hyades::cli {

using core::Rgb;
using nlohmann::ordered_json;

namespace {

/// "#e8d9c0": the colour on a display.
std::string hex(const Rgb& color) {
  const Rgb shown = core::srgb_encode(glm::clamp(color, 0.0F, 1.0F)) * 255.0F;
  return fmt::format("#{:02x}{:02x}{:02x}", std::lround(shown.x), std::lround(shown.y),
                     std::lround(shown.z));
}

/// A length in words of a size that suits it; the shortest of the three.
std::string shortest(const Rgb& lengths) {
  const float metres = core::min_component(lengths);
  if (std::isinf(metres)) return "infinite";
  if (metres < 1e-3F) return fmt::format("{:.3g} um", metres * 1e6F);
  if (metres < 1.0F) return fmt::format("{:.3g} mm", metres * 1e3F);
  return fmt::format("{:.3g} m", metres);
}

std::string row(const char* what, const Rgb& value, const std::string& unit) {
  return fmt::format("  {:<24}{:>12.6g}{:>12.6g}{:>12.6g}  {}\n", what, value.x, value.y, value.z,
                     unit);
}

/// Seven digits say all that a float holds to people; infinity is nothing in JSON.
ordered_json number(float value) {
  if (!std::isfinite(value)) return nullptr;
  return std::stod(fmt::format("{:.7g}", value));
}

ordered_json list(const Rgb& value) { return {number(value.x), number(value.y), number(value.z)}; }

ordered_json one_or_list(const Rgb& value) {
  return value.x == value.y && value.y == value.z ? number(value.x) : list(value);
}

}  // namespace

std::string media_table(const std::vector<KnownMedium>& media) {
  std::string text = fmt::format("{:<30}{:<9}{:<12}{:>12}  {:<22}{}\n", "name", "thick",
                                 "1 cm of it", "free path", "albedo", "from");
  for (const KnownMedium& medium : media) {
    const MediumFacts facts = facts_of(medium);
    text += fmt::format("{:<30}{:<9}{:<12}{:>12}  {:<6.4f} {:<6.4f} {:<6.4f}  {}\n", medium.name,
                        hex(facts.seen_reflectance), hex(facts.in_a_layer),
                        shortest(facts.mean_free_path), facts.albedo.x, facts.albedo.y,
                        facts.albedo.z, medium.source);
  }
  return text;
}

std::string medium_sheet(const KnownMedium& medium, const LengthUnit& unit) {
  const MediumFacts facts = facts_of(medium);
  const float m = unit.metres;
  const std::string per = "1/" + unit.name;
  std::string text =
      fmt::format("{}  ({}, index {:.4g})\n", medium.name, medium.source, medium.index);
  text += fmt::format("  {:<24}{:>12}{:>12}{:>12}\n", "", "red", "green", "blue");
  text += row("absorption", medium.absorption * m, per);
  text += row("scattering", medium.scattering * m, per);
  text += row("g", medium.g, "");
  text += row("extinction", facts.extinction * m, per);
  text += row("mean free path", facts.mean_free_path / m, unit.name);
  text += row("transport mean free path", facts.transport_path / m, unit.name);
  text += row("albedo", facts.albedo, "");
  text += row("thick block reflects", facts.block_reflectance, hex(facts.block_reflectance));
  text += row("behind its surface", facts.seen_reflectance, hex(facts.seen_reflectance));
  text += row("a layer of 1 cm", facts.in_a_layer, hex(facts.in_a_layer));
  return text;
}

std::string media_json(const std::vector<KnownMedium>& media, const LengthUnit& unit) {
  ordered_json all = ordered_json::array();
  for (const KnownMedium& medium : media) {
    const MediumFacts facts = facts_of(medium);
    const float m = unit.metres;
    all.push_back({{"name", medium.name},
                   {"source", medium.source},
                   {"unit", unit.name},
                   {"absorption", list(medium.absorption * m)},
                   {"scattering", list(medium.scattering * m)},
                   {"g", list(medium.g)},
                   {"index", number(medium.index)},
                   {"extinction", list(facts.extinction * m)},
                   {"mean_free_path", list(facts.mean_free_path / m)},
                   {"transport_mean_free_path", list(facts.transport_path / m)},
                   {"albedo", list(facts.albedo)},
                   {"block_reflectance", list(facts.block_reflectance)},
                   {"seen_reflectance", list(facts.seen_reflectance)},
                   {"in_a_layer", list(facts.in_a_layer)}});
  }
  return all.dump(2) + "\n";
}

std::string media_file_json(const KnownMedium& medium, const LengthUnit& unit) {
  return fmt::format(
      "{{\"name\": {}, \"absorption\": {}, \"scattering\": {}, \"g\": {}, \"index\": {}}}\n",
      ordered_json(medium.name).dump(), list(medium.absorption * unit.metres).dump(),
      list(medium.scattering * unit.metres).dump(), one_or_list(medium.g).dump(),
      number(medium.index).dump());
}

std::string media_file_yaml(const KnownMedium& medium, const LengthUnit& unit) {
  return fmt::format(
      "# {}, for jobs whose unit is {}: media: {{file: ...}}\nmedia:\n  {}:\n    absorption: {}\n  "
      "  "
      "scattering: {}\n    g: {}\n    index: {}\n",
      medium.source, unit.name, medium.name, list(medium.absorption * unit.metres).dump(),
      list(medium.scattering * unit.metres).dump(), one_or_list(medium.g).dump(),
      number(medium.index).dump());
}

}  // namespace hyades::cli
