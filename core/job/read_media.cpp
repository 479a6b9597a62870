#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/job/read_sections.h"

namespace hyades::core {

namespace {

/// Complains where `key` stands beside any of `others`; whether it did.
bool stands_beside(MapReader& reader, std::string_view key,
                   std::span<const std::string_view> others) {
  if (!reader.has(key)) return false;
  for (const std::string_view other : others) {
    if (!reader.has(other)) continue;
    reader.complain(reader.where_of(key), reader.what() + " has both " + std::string(key) +
                                              " and " + std::string(other) +
                                              ", expected one way of saying how dense it is");
    return true;
  }
  return false;
}

/// Coefficients, or an albedo with a length or a density.
void check_density(MapReader& reader, const MediumDesc& medium) {
  static constexpr std::array<std::string_view, 2> kCoefficients = {"absorption", "scattering"};
  static constexpr std::array<std::string_view, 1> kLength = {"mean_free_path"};
  if (stands_beside(reader, "albedo", kCoefficients) ||
      stands_beside(reader, "mean_free_path", kCoefficients) ||
      (!medium.varying && (stands_beside(reader, "density", kCoefficients) ||
                           stands_beside(reader, "density", kLength)))) {
    return;
  }
  if (medium.varying && medium.albedo) return;
  if (medium.albedo.has_value() != (medium.density || medium.mean_free_path)) {
    const char* there = medium.albedo ? "albedo" : medium.density ? "density" : "mean_free_path";
    reader.complain(reader.where_of(there), reader.what() + " has " + there +
                                                " alone, expected albedo together with " +
                                                "mean_free_path or density");
  }
}

/// Grids are those of the density's vdb.
void check_emission(MapReader& reader, const MediumDesc& medium) {
  if (!medium.emission || (medium.varying && !medium.varying->vdb.empty())) return;
  const YamlNode& emission = *reader.node().find("emission")->value;
  if (emission.kind != YamlNode::Kind::map) return;
  for (const char* key : {"grid", "temperature"}) {
    const YamlEntry* entry = emission.find(key);
    if (entry == nullptr) continue;
    reader.complain(entry->value->where,
                    std::string(key) + " names a grid, but the medium's density is of no vdb");
  }
}

}  // namespace

void check_keys(MapReader& reader, ShellDensityDesc& shell) {
  const bool still = shell.inner.is_constant() && shell.outer.is_constant();
  if (still && shell.inner.constant >= shell.outer.constant) {
    reader.complain(reader.where(), reader.what() +
                                        " has an inner radius that is not below the "
                                        "outer one");
  }
}

void check_keys(MapReader& reader, DensityDesc& /*density*/) {
  for (const char* key : {"grid", "tint", "place", "transform", "at"}) {
    if (reader.has("vdb") || !reader.has(key)) continue;
    reader.complain(reader.where_of(key), std::string(key) + " belongs to a density of a vdb");
  }
  const int kinds =
      (reader.has("vdb") ? 1 : 0) + (reader.has("noise") ? 1 : 0) + (reader.has("shell") ? 1 : 0);
  if (kinds != 1) {
    reader.complain(reader.where(), reader.what() + (kinds == 0 ? " has none" : " has several") +
                                        " of vdb, noise and shell, expected one");
  }
}

void check_keys(MapReader& reader, MediumDesc& medium) {
  check_density(reader, medium);
  check_emission(reader, medium);
  if (medium.phase != "rayleigh") return;
  for (const char* key : {"g", "g2", "blend"}) {
    if (!reader.has(key)) continue;
    reader.complain(reader.where_of(key),
                    std::string(key) + " belongs to phase henyey-greenstein, not to rayleigh");
  }
}

void read_media(MapReader& top) {
  read_named(top, "media", "medium", NameKind::medium,
             [](MapReader& reader, const std::string& name) {
               MediumDesc medium;
               medium.name = name;
               medium.where = reader.where();
               read_fields(reader, medium);
               reader.finish();
               reader.context().job.media.push_back(std::move(medium));
             });
}

void read_atmosphere(MapReader& top, Job& job) {
  top.name_of("atmosphere", job.atmosphere, NameKind::medium);
}

}  // namespace hyades::core
