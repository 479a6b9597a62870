#include "core/scene/volume_makers.h"

#include <utility>

#include "core/media/noise_density.h"

namespace hyades::core {
namespace {

/// Of procedural densities, along the longest side: bounds of noise are narrow only over boxes well
/// below its own cells, and take their time.
constexpr int kProceduralCells = 32;

PlacedVolume in_body(std::shared_ptr<const DensityField> density) {
  const Vec3i cells = MajorantGrid::cells_for(density->bounds(), kProceduralCells);
  MajorantGrid majorants(*density, cells);
  return {std::make_shared<const Volume>(
      Volume{std::move(density), std::move(majorants), nullptr, nullptr})};
}

PlacedVolume make_noise(const NoiseDensityDesc& desc, const JobTime& time, const Bounds& body) {
  NoiseDensity noise;
  noise.scale = desc.scale.at(time);
  noise.offset = desc.offset.at(time);
  noise.octaves = desc.octaves;
  noise.lacunarity = desc.lacunarity;
  noise.gain = desc.gain;
  noise.time = desc.time.at(time);
  noise.low = desc.low.at(time);
  noise.high = desc.high.at(time);
  noise.fade = desc.fade.at(time);
  return in_body(make_noise_density(noise, body));
}

}  // namespace

Result<PlacedVolume> make_volume(const DensityDesc& desc, const JobTime& time, const Bounds& body,
                                 SceneCache&) {
  if (desc.noise) return make_noise(*desc.noise, time, body);
  return Error{"a density that varies in no known way"};
}

}  // namespace hyades::core
