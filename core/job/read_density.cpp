#include "core/job/read_density.h"

#include <array>

#include "core/job/kinds.h"
#include "core/job/read_sections.h"

namespace hyades::core {

namespace {

const std::array<std::string, 2> kVdbPlaces = {"fit", "native"};

/// The keys of a density that its vdb needs.
constexpr std::array<const char*, 5> kOfVdb = {"grid", "tint", "place", "transform", "at"};

void read_noise(MapReader& reader, NoiseDensityDesc& noise) {
  reader.animated_scale("scale", noise.scale, kAnyNumber);
  reader.animated_scale("offset", noise.offset, kAnyNumber);
  reader.integer("octaves", noise.octaves, 1, 16);
  reader.animated("lacunarity", noise.lacunarity, {1.0, 16.0});
  reader.animated("gain", noise.gain, {0.0, 4.0});
  reader.animated("time", noise.time, kAnyNumber);
  reader.animated("low", noise.low, kUnitInterval);
  reader.animated("high", noise.high, kUnitInterval);
  reader.animated("fade", noise.fade, kUnitInterval);
}

void read_shell(MapReader& reader, ShellDensityDesc& shell) {
  reader.require("image", "an image file");
  reader.file("image", shell.image);
  reader.animated("inner", shell.inner, kNotNegative);
  reader.animated("outer", shell.outer, kPositive);
  reader.animated("rotate_y", shell.rotate_y, kAnyNumber);
  reader.animated("low", shell.low, kNotNegative);
  reader.animated("high", shell.high, kNotNegative);
  reader.flag("tint", shell.tint);
  reader.animated("swirl", shell.swirl, kNotNegative);
  reader.animated("scale", shell.scale, kNotNegative);
  reader.integer("octaves", shell.octaves, 1, 16);
  reader.animated("time", shell.time, kAnyNumber);
  const bool still = shell.inner.is_constant() && shell.outer.is_constant();
  if (still && shell.inner.constant >= shell.outer.constant && !reader.listing()) {
    reader.complain(reader.where(), reader.what() +
                                        " has an inner radius that is not below the "
                                        "outer one");
  }
}

void read_vdb(MapReader& reader, DensityDesc& density) {
  reader.file("vdb", density.vdb);
  reader.text("grid", density.grid, "the name of a grid of numbers in the file");
  reader.text("tint", density.tint, "the name of a grid of colours in the file");
  reader.choice("place", density.place, kVdbPlaces);
  read_transform(reader, density.transform, density.at);
  if (reader.has("vdb")) return;
  for (const char* key : kOfVdb) {
    if (!reader.has(key)) continue;
    reader.complain(reader.find(key)->where, std::string(key) + " belongs to a density of a vdb");
  }
}

void read_kinds(MapReader& reader, DensityDesc& density) {
  read_vdb(reader, density);
  reader.map("noise", "media.density.noise", [&](MapReader& map) {
    density.noise.emplace();
    read_noise(map, *density.noise);
  });
  reader.map("shell", "media.density.shell", [&](MapReader& map) {
    density.shell.emplace();
    read_shell(map, *density.shell);
  });
  reader.number("march", density.march, kNotNegative);
  if (reader.listing()) return;
  const int kinds =
      (reader.has("vdb") ? 1 : 0) + (reader.has("noise") ? 1 : 0) + (reader.has("shell") ? 1 : 0);
  if (kinds != 1) {
    reader.complain(reader.where(), reader.what() + (kinds == 0 ? " has none" : " has several") +
                                        " of vdb, noise and shell, expected one");
  }
}

bool is_map_of_keys(const YamlNode* node) {
  return node != nullptr && node->kind == YamlNode::Kind::map && node->find("keys") == nullptr;
}

}  // namespace

std::span<const std::string> vdb_places() { return kVdbPlaces; }

void read_varying_density(MapReader& reader, std::optional<DensityDesc>& density) {
  if (!is_map_of_keys(reader.find("density")) && !reader.listing()) return;
  reader.map("density", "media.density", [&](MapReader& map) {
    density.emplace();
    read_kinds(map, *density);
  });
}

void read_emission(MapReader& reader, MediumDesc& medium) {
  const YamlNode* node = reader.find("emission");
  const bool varies = is_map_of_keys(node);
  if (!varies) reader.color("emission", medium.emission, kNotNegative);
  if (!varies && !reader.listing()) return;
  reader.map("emission", "media.emission", [&](MapReader& map) {
    GlowDesc glow;
    medium.emission = Animated<Rgb>(Rgb(1.0F));
    map.color("color", medium.emission, kNotNegative);
    map.animated("strength", medium.emission_strength, kNotNegative);
    map.text("grid", glow.grid, "the name of a grid of numbers");
    map.text("temperature", glow.temperature, "the name of a grid of numbers");
    map.animated("kelvin", glow.kelvin, kPositive);
    if (map.listing()) return;
    const bool in_vdb = medium.varying && !medium.varying->vdb.empty();
    for (const char* key : {"grid", "temperature"}) {
      if (!map.has(key) || in_vdb) continue;
      map.complain(map.find(key)->where,
                   std::string(key) + " names a grid, but the medium's density is of no vdb");
    }
    if (in_vdb && !(glow.grid.empty() && glow.temperature.empty())) medium.glow = glow;
  });
}

}  // namespace hyades::core
