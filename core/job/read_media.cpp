#include <array>

#include "core/job/kinds.h"
#include "core/job/light_groups.h"
#include "core/job/read_density.h"
#include "core/job/read_preset.h"
#include "core/job/read_sections.h"

namespace hyades::core {

namespace {

constexpr Range kCosine{-1.0, 1.0, true, true};

const std::array<std::string, 2> kPhases = {"henyey-greenstein", "rayleigh"};

/// Complains where `key` stands beside any of `others`; whether it did.
bool stands_beside(MapReader& reader, std::string_view key,
                   std::span<const std::string_view> others) {
  if (!reader.has(key)) return false;
  for (const std::string_view other : others) {
    if (!reader.has(other)) continue;
    reader.complain(reader.find(key)->where, reader.what() + " has both " + std::string(key) +
                                                 " and " + std::string(other) +
                                                 ", expected one way of saying how dense it is");
    return true;
  }
  return false;
}

/// Coefficients, or an albedo with a length or a density.
void read_density(MapReader& reader, MediumDesc& medium) {
  reader.color("absorption", medium.absorption, kNotNegative);
  reader.color("scattering", medium.scattering, kNotNegative);
  reader.color("albedo", medium.albedo, kUnitInterval);
  reader.color("mean_free_path", medium.mean_free_path, kPositive);
  if (!medium.varying) reader.color("density", medium.density, kNotNegative);
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
    reader.complain(reader.find(there)->where, reader.what() + " has " + there +
                                                   " alone, expected albedo together with " +
                                                   "mean_free_path or density");
  }
}

void read_phase(MapReader& reader, MediumDesc& medium) {
  reader.choice("phase", medium.phase, kPhases);
  reader.color("g", medium.g, kCosine);
  reader.color("g2", medium.g2, kCosine);
  reader.animated("blend", medium.blend, kUnitInterval);
  if (medium.phase == "rayleigh") {
    for (const char* key : {"g", "g2", "blend"}) {
      if (!reader.has(key)) continue;
      reader.complain(reader.find(key)->where,
                      std::string(key) + " belongs to phase henyey-greenstein, not to rayleigh");
    }
  }
}

}  // namespace

std::span<const std::string> phase_names() { return kPhases; }

void read_media(MapReader& top) {
  read_named(top, "media", "medium", NameKind::medium,
             [&](const YamlNode& node, const std::string& name, const std::string& what,
                 const std::string& path) {
               MapReader reader(top.context(), node, what, path, "media");
               if (node.kind != YamlNode::Kind::map) return;
               MediumDesc medium;
               medium.name = name;
               medium.where = node.where;
               reader.find("like");
               read_varying_density(reader, medium.varying);
               read_preset(reader, medium);
               read_density(reader, medium);
               read_phase(reader, medium);
               read_index(reader, medium);
               read_emission(reader, medium);
               reader.animated("scale", medium.scale, kNotNegative);
               read_light_group(reader, medium.light_group);
               reader.finish();
               top.context().job.media.push_back(std::move(medium));
             });
}

void read_atmosphere(MapReader& top, Job& job) {
  top.name_of("atmosphere", job.atmosphere, NameKind::medium);
}

}  // namespace hyades::core
