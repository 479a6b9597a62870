#include "core/job/read_density.h"

namespace hyades::core {

namespace {

void read_noise(MapReader& reader, NoiseDensityDesc& noise) {
  reader.animated_scale("scale", noise.scale, kAnyNumber);
  reader.animated_scale("offset", noise.offset, kAnyNumber);
  reader.integer("octaves", noise.octaves, 1, 16);
  reader.number("lacunarity", noise.lacunarity, {1.0, 16.0});
  reader.number("gain", noise.gain, {0.0, 4.0});
  reader.animated("time", noise.time, kAnyNumber);
  reader.animated("low", noise.low, kUnitInterval);
  reader.animated("high", noise.high, kUnitInterval);
  reader.animated("fade", noise.fade, kUnitInterval);
}

void read_kinds(MapReader& reader, DensityDesc& density) {
  reader.map("noise", "media.density.noise", [&](MapReader& map) {
    density.noise.emplace();
    read_noise(map, *density.noise);
  });
  if (!density.noise) {
    reader.complain(reader.where(), reader.what() + " does not say how it varies, expected noise");
  }
}

}  // namespace

void read_varying_density(MapReader& reader, std::optional<DensityDesc>& density) {
  const YamlNode* node = reader.find("density");
  const bool varies =
      node != nullptr && node->kind == YamlNode::Kind::map && node->find("keys") == nullptr;
  if (!varies && !reader.listing()) return;
  reader.map("density", "media.density", [&](MapReader& map) {
    density.emplace();
    read_kinds(map, *density);
  });
}

}  // namespace hyades::core
